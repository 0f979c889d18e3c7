// The classes of JSONTestSuite (Nicolas Seriot, "Parsing JSON is a minefield"), its texts written
// out by hand: those that every parser must accept, those that it must refuse, and those that RFC
// 8259 leaves open, decided here.

#include <gtest/gtest.h>

#include <string>

#include "api/wire/json.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {
namespace {

// clang-format off: a table
constexpr const char* kAccepted[] = {
    "[[]   ]",
    "[\"\"]",
    "[]",
    "[\"a\"]",
    "[false]",
    "[null, 1, \"1\", {}]",
    "[null]",
    "[1\n]",
    " [1]",
    "[1,null,null,null,2]",
    "[2] ",
    "[123e65]",
    "[0e+1]",
    "[0e1]",
    "[ 4]",
    "[-0.000000000000000000000000000000000000000000000000000000000000000000000000000001]",
    "[20e1]",
    "[-0]",
    "[-123]",
    "[-1]",
    "[-0.0]",
    "[1E22]",
    "[1E-2]",
    "[1E+2]",
    "[123e45]",
    "[123.456e78]",
    "[1e-2]",
    "[1e+2]",
    "[123]",
    "[123.456789]",
    "{\"asd\":\"sdf\", \"dfg\":\"fgh\"}",
    "{\"asd\":\"sdf\"}",
    "{}",
    "{\"\":0}",
    "{\"foo\\u0000bar\": 42}",
    "{ \"min\": -1.0e+28, \"max\": 1.0e+28 }",
    "{\"x\":[{\"id\": \"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\"}], \"id\": "
    "\"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\"}",
    "{\"a\":[]}",
    "{\"title\":\"\\u041f\\u043e\\u043b\" }",
    "{\n\"a\": \"b\"\n}",
    "[\"\\u0060\\u012a\\u12AB\"]",
    "[\"\\uD801\\udc37\"]",
    "[\"\\ud83d\\ude39\\ud83d\\udc8d\"]",
    "[\"\\\"\\\\\\/\\b\\f\\n\\r\\t\"]",
    "[\"\\\\u0000\"]",
    "[\"\\\"\"]",
    "[\"a/*b*/c/*d//e\"]",
    "[\"\\\\a\"]",
    "[\"\\\\n\"]",
    "[\"\\u0012\"]",
    "[\"\\uFFFF\"]",
    "[\"asd\"]",
    "[ \"asd\"]",
    "[\"\\uDBFF\\uDFFF\"]",
    "[\"new\\u00A0line\"]",
    "[\"\\u0000\"]",
    "[\"\\u002c\"]",
    "[\"\\uD834\\uDd1e\"]",
    "[\"\\u0821\"]",
    "[\"\\u0123\"]",
    "[\"\342\200\250\"]",
    "[\"\342\200\251\"]",
    "\"  \"",
    "[\"\360\233\277\277\"]",
    "[\"\357\277\277\"]",
    "[\"\364\217\277\277\"]",
    "[\"\\uA66D\"]",
    "[\"\\u005C\"]",
    "[\"\\u0022\"]",
    "[\"\\u200B\"]",
    "[\"\\u2064\"]",
    "[\"\\uFDD0\"]",
    "[\"\\uFFFE\"]",
    "[\"\342\202\254\360\235\204\236\"]",
    "[\"a\177a\"]",
    "false",
    "42",
    "-0.1",
    "null",
    "\"asd\"",
    "true",
    "\"\"",
    "[\"a\"]\n",
    "[true]",
    " [] ",
};

constexpr const char* kRefused[] = {
    "[1 true]",
    "[a\345]",
    "[\"\": 1]",
    "[\"\"],",
    "[,1]",
    "[1,,2]",
    "[\"x\",,]",
    "[\"x\"]]",
    "[\"\",]",
    "[\"x\"",
    "[x",
    "[3[4]]",
    "[\377]",
    "[1:2]",
    "[,]",
    "[-]",
    "[   , \"\"]",
    "[\"a\",\n4\n,1,",
    "[1,]",
    "[1,,]",
    "[\"\013a\"\\f]",
    "[*]",
    "[\"\"",
    "[1,",
    "[1,\n1\n,1",
    "[{}",
    "[fals]",
    "[nul]",
    "[tru]",
    "[++1234]",
    "[+1]",
    "[+Inf]",
    "[-01]",
    "[-1.0.]",
    "[-2.]",
    "[-NaN]",
    "[.-1]",
    "[.2e-3]",
    "[0.1.2]",
    "[0.3e+]",
    "[0.3e]",
    "[0.e1]",
    "[0E+]",
    "[0E]",
    "[0e+]",
    "[0e]",
    "[1.0e+]",
    "[1.0e-]",
    "[1.0e]",
    "[1 000.0]",
    "[1eE2]",
    "[2.e+3]",
    "[2.e-3]",
    "[2.e3]",
    "[9.e+]",
    "[Inf]",
    "[NaN]",
    "[\357\274\221]",
    "[1+2]",
    "[0x1]",
    "[0x42]",
    "[Infinity]",
    "[0e+-1]",
    "[-123.123foo]",
    "[123\345]",
    "[1e1\345]",
    "[0\345]",
    "[-Infinity]",
    "[-foo]",
    "[- 1]",
    "[-012]",
    "[-.123]",
    "[-1x]",
    "[1ea]",
    "[1e\345]",
    "[1.]",
    "[.123]",
    "[1.2a-3]",
    "[1.8011670033376514H-308]",
    "[012]",
    "[\"x\", truth]",
    "{[: \"x\"}\n",
    "{\"x\", null}",
    "{\"x\"::\"b\"}",
    "{\360\237\207\250\360\237\207\255}",
    "{\"a\":\"a\" 123}",
    "{key: 'value'}",
    "{\"\271\":\"0\",}",
    "{\"a\" b}",
    "{:\"b\"}",
    "{\"a\" \"b\"}",
    "{\"a\":",
    "{\"a\"",
    "{1:1}",
    "{9999E9999:1}",
    "{null:null,null:null}",
    "{\"id\":0,,,,,}",
    "{'a':0}",
    "{\"id\":0,}",
    "{\"a\":\"b\"}/**/",
    "{\"a\":\"b\"}/**//",
    "{\"a\":\"b\"}//",
    "{\"a\":\"b\"}/",
    "{\"a\":\"b\",,\"c\":\"d\"}",
    "{a: \"b\"}",
    "{\"a\":\"a",
    "{ \"foo\" : \"bar\", \"a\" }",
    "{\"a\":\"b\"}#",
    " ",
    "[\"\\uD800\\\"]",
    "[\"\\uD800\\u\"]",
    "[\"\\uD800\\u1\"]",
    "[\"\\uD800\\u1x\"]",
    "[\303\251]",
    "[\"\\x00\"]",
    "[\"\\\\\\\"]",
    "[\"\\\t\"]",
    "[\"\\\360\237\214\200\"]",
    "[\"\\\"]",
    "[\"\\u00A\"]",
    "[\"\\uD834\\uDd\"]",
    "[\"\\uD800\\uD800\\x\"]",
    "[\"\\u\345\"]",
    "[\"\\a\"]",
    "[\"\\uqqqq\"]",
    "[\"\\\345\"]",
    "[\\u0020\"asd\"]",
    "[\\n]",
    "\"",
    "['single quote']",
    "abc",
    "[\"\\",
    "[\"new\nline\"]",
    "[\"\t\"]",
    "\"\\UA66D\"",
    "\"\"x",
    "<.>",
    "[<null>]",
    "[1]x",
    "[1]]",
    "[\"asd]",
    "a\303\245",
    "[True]",
    "1]",
    "{\"x\": true,",
    "[][]",
    "]",
    "\357\273{}",
    "\345",
    "[",
    "",
    "2@",
    "{}}",
    "{\"\":",
    "{\"a\":/*comment*/\"b\"}",
    "{\"a\": true} \"x\"",
    "['",
    "[,",
    "[{",
    "[\"a",
    "[\"a\"",
    "{",
    "{]",
    "{,",
    "{[",
    "{\"a",
    "{'a'",
    "[\"\\{[\"\\{[\"\\{[\"\\{",
    "\351",
    "*",
    "{\"a\":\"b\"}#{}",
    "[\\u000A\"\"]",
    "[1",
    "[ false, nul",
    "[ true, fals",
    "[ false, tru",
    "{\"asd\":\"asd\"",
    "\303\245",
    "[\342\201\240]",
    "[\014]",
};

/// All refused: a wrong number here scraps steel, so nothing is guessed.
struct Undecided {
  const char* text;
  const char* reason;
};
constexpr Undecided kUndecided[] = {
    {"[123.456e-789]", "number too small"},
    {"[0."
     "4e0066999999999999999999999999999999999999999999999999999999999999999999999999999999999999999"
     "9999999999999999999999999969999999006]",
     "number too large"},
    {"[-1e+9999]", "number too large"},
    {"[1.5e+9999]", "number too large"},
    {"[-123123e100000]", "number too large"},
    {"[123123e100000]", "number too large"},
    {"[123e-10000000]", "number too small"},
    {"[-123123123123123123123123123123]", "integer beyond 2^53"},
    {"[100000000000000000000]", "integer beyond 2^53"},
    {"[-237462374673276894279832749832423479823246327846]", "integer beyond 2^53"},
    {"{\"\\uDFAA\":0}", "not valid JSON"},
    {"[\"\\uDADA\"]", "not valid JSON"},
    {"[\"\\uD888\\u1234\"]", "not valid JSON"},
    {"[\"\346\227\245\321\210\372\"]", "not valid JSON"},
    {"[\"\355\240\200\"]", "not valid JSON"},
    {"[\"\\uD800\\n\"]", "not valid JSON"},
    {"[\"\\uDd1ea\"]", "not valid JSON"},
    {"[\"\\uD800\\uD800\\n\"]", "not valid JSON"},
    {"[\"\\ud800\"]", "not valid JSON"},
    {"[\"\\ud800abc\"]", "not valid JSON"},
    {"[\"\377\"]", "not valid JSON"},
    {"[\"\\uDd1e\\uD834\"]", "not valid JSON"},
    {"[\"\351\"]", "not valid JSON"},
    {"[\"\\uDFAA\"]", "not valid JSON"},
    {"[\"\201\"]", "not valid JSON"},
    {"[\"\364\277\277\277\"]", "not valid JSON"},
    {"[\"\300\257\"]", "not valid JSON"},
    {"[\"\374\203\277\277\277\277\"]", "not valid JSON"},
    {"[\"\374\200\200\200\200\200\"]", "not valid JSON"},
    {"[\"\340\377\"]", "not valid JSON"},
    {"\357\273\277{}", "byte order mark"},
};

/// The suite accepts these, but we refuse them with a reason, because otherwise the last of two
/// equal keys would win without a message.
constexpr Undecided kStricter[] = {
    {"{\"a\":\"b\",\"a\":\"c\"}", "duplicate key"},
    {"{\"a\":\"b\",\"a\":\"b\"}", "duplicate key"},
};
// clang-format on

TEST(JsonSuite, EveryMustAcceptIsAccepted) {
  EXPECT_GE(std::size(kAccepted), 80U);
  for (const char* text : kAccepted) {
    const auto json = parse(text);
    ASSERT_TRUE(json) << text << ": " << json.error().reason << " at " << json.error().offset;
    const auto again = parse(dump(*json));
    ASSERT_TRUE(again) << text;
    EXPECT_TRUE(*again == *json) << text << " printed as " << dump(*json);
  }
}

TEST(JsonSuite, EveryMustRejectIsRefused) {
  EXPECT_GE(std::size(kRefused), 150U);
  for (const char* text : kRefused) EXPECT_FALSE(parse(text)) << text;
  for (const std::string& text :
       {std::string("[\"a\0a\"]", 7), std::string("[\0]", 3), std::string("\0", 1),
        std::string("{}\0", 3), std::string(100000, '['), std::string("[\"\\\0\"]", 6)}) {
    EXPECT_FALSE(parse(text)) << text.size();
  }
}

TEST(JsonSuite, TheUndecidedAreDecided) {
  for (const auto& row : kUndecided) {
    const auto json = parse(row.text);
    ASSERT_FALSE(json) << row.text;
    EXPECT_EQ(json.error().reason, row.reason) << row.text;
  }
  for (const auto& row : kStricter) {
    ASSERT_FALSE(parse(row.text)) << row.text;
    EXPECT_EQ(parse(row.text).error().reason, row.reason) << row.text;
  }
  EXPECT_EQ(parse(std::string(500, '[') + std::string(500, ']')).error().reason,
            "nested too deeply");
  const std::string utf16("[\0\"\0\xe9\0\"\0]\0", 10);
  EXPECT_FALSE(parse(utf16));
  EXPECT_FALSE(parse("\xff\xfe" + utf16));
}

TEST(JsonSuite, EveryNumberWePrintIsOneWeRead) {
  const double numbers[] = {9007199254740991.0,
                            9007199254740992.0,
                            9007199254740994.0,
                            1e16,
                            12345678901234568.0,
                            1.8446744073709552e19,
                            1e21,
                            1e22,
                            123456789012345680000.0,
                            1.7976931348623157e308,
                            2.2250738585072014e-308,
                            0.1,
                            4294967296.0};
  for (const double magnitude : numbers) {
    for (const double number : {magnitude, -magnitude}) {
      std::string text;
      append_number(text, number);
      const auto json = parse(text);
      ASSERT_TRUE(json) << text << ": " << json.error().reason;
      EXPECT_EQ(*json->as<double>(), number) << text;
    }
  }
}

}  // namespace
}  // namespace tubecut::api
