// The permitted characters of a text, and its spelling in ASCII formats.

#include "api/wire/text_encoding.hpp"

#include <gtest/gtest.h>

#include "api/formats/text.hpp"

namespace tubecut::api {
namespace {

TEST(Letters, TakesCharactersOfEveryLength) {
  std::string_view text = "a\xC3\xA4\xE6\xB3\xA8\xF0\xA0\xAE\xB7";
  for (const char32_t expected : {U'a', U'\u00E4', U'\u6CE8', U'\U00020BB7'})
    EXPECT_EQ(take_character(text), expected);
  EXPECT_TRUE(text.empty());
}

TEST(Letters, RefusesInvalidUtf8) {
  for (const std::string text :
       {"\x80", "\xC0\x80", "\xC1\xBF", "\xC3", "\xC3\x28", "\xE0\x80\x80", "\xE2\x82",
        "\xED\xA0\x80", "\xF0\x80\x80\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF"}) {
    EXPECT_FALSE(is_utf8(text));
    EXPECT_FALSE(is_visible(text, 64));
    EXPECT_FALSE(in_ascii(text));
  }
}

TEST(Letters, AreCountedNotTheirBytes) {
  std::string text;
  for (int i = 0; i < 64; ++i) text += "\xF0\xA0\xAE\xB7";
  EXPECT_TRUE(is_visible(text, 64));
  EXPECT_FALSE(is_visible(text + "x", 64));
  EXPECT_FALSE(is_visible("", 64));
}

TEST(Letters, AreSpelledOrNot) {
  EXPECT_EQ(in_ascii("M\xC3\xBCller \xC3\x98"
                     "60 \xC5\x81\xC3\xB3"
                     "d\xC5\xBA"),
            "Mueller O60 Lodz");
  EXPECT_EQ(in_ascii("plain ~ text"), "plain ~ text");
  EXPECT_FALSE(
      in_ascii("\xD0\xA2"
               "A"));
  EXPECT_EQ(gcode_text("\xC3\xA4 (x)"), "ae _x_, spelled in ASCII");
  EXPECT_EQ(gcode_text("a (x)"), "a _x_");
  EXPECT_THROW(static_cast<void>(dstv_text("\xE6\xB3\xA8")), Unspellable);
  EXPECT_EQ(dxf_text("\xE6\xB3\xA8\xF0\xA0\xAE\xB7\\"), "\\U+6CE8\\U+D842\\U+DFB7\\U+005C");
}

}  // namespace
}  // namespace tubecut::api
