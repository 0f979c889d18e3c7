#include "core/cutout/stroke_font.hpp"

#include <array>
#include <string_view>

namespace tubecut::cutout {
namespace {

/// Strokes of each letter, divided by spaces: pairs of hexadecimal digits are x and y in halves of
/// a unit.
constexpr std::array<std::string_view, kLastLetter - kFirstLetter + 1> kLetters{
    /*   */ "",
    /* ! */ "4e45 4140",
    /* " */ "2e2a 6e6a",
    /* # */ "2d21 6d61 0a8a 0484",
    /* $ */ "8a6c2c0a0927678584622204 4e40",
    /* % */ "008e 0e2e2c0c0e 6260808262",
    /* & */ "801a1c3e5e6c6a0502204085",
    /* ' */ "4e4a",
    /* ( */ "5e3b3350",
    /* ) */ "3e5b5330",
    /* * */ "4b43 1975 1579",
    /* + */ "4b43 0787",
    /* , */ "4230",
    /* - */ "1777",
    /* . */ "4140",
    /* / */ "008e",
    /* 0 */ "20020c2e6e8c826020 137b",
    /* 1 */ "2b4e40 2060",
    /* 2 */ "0c2e6e8c890080",
    /* 3 */ "0c2e6e8c89678582602002 3767",
    /* 4 */ "606e0484",
    /* 5 */ "8e0e08688682602002",
    /* 6 */ "7e4e0a02206082866808",
    /* 7 */ "0e8e30",
    /* 8 */ "27090c2e6e8c89672705022060828567",
    /* 9 */ "1040848c6e2e0c082686",
    /* : */ "4a49 4544",
    /* ; */ "4a49 4532",
    /* < */ "7b1773",
    /* = */ "1979 1575",
    /* > */ "1b7713",
    /* ? */ "0c2e6e8c8a4744 4140",
    /* @ */ "826020020c2e6e8c85454a8a",
    /* A */ "000a4e8a80 0585",
    /* B */ "000e6e8c896707 6785826000",
    /* C */ "8c6e2e0c02206082",
    /* D */ "000e5e8b835000",
    /* E */ "8e0e0080 0767",
    /* F */ "000e8e 0767",
    /* G */ "8c6e2e0c022060828747",
    /* H */ "000e 808e 0787",
    /* I */ "2e6e 4e40 2060",
    /* J */ "8e82602002",
    /* K */ "000e 8e06 2880",
    /* L */ "0e0080",
    /* M */ "000e478e80",
    /* N */ "000e808e",
    /* O */ "20020c2e6e8c826020",
    /* P */ "000e6e8c896707",
    /* Q */ "20020c2e6e8c826020 5380",
    /* R */ "000e6e8c896707 4780",
    /* S */ "8c6e2e0c0927678582602002",
    /* T */ "0e8e 4e40",
    /* U */ "0e022060828e",
    /* V */ "0e408e",
    /* W */ "0e2048608e",
    /* X */ "008e 0e80",
    /* Y */ "0e478e 4740",
    /* Z */ "0e8e0080",
    /* [ */ "5e3e3050",
    /* \ */ "0e80",
    /* ] */ "3e5e5030",
    /* ^ */ "1b4e7b",
    /* _ */ "0080",
    /* ` */ "3e5b",
    /* a */ "1a6a88802002042686",
    /* b */ "0e006082886a0a",
    /* c */ "8a2a08022080",
    /* d */ "8e802002082a8a",
    /* e */ "0585886a2a08022070",
    /* f */ "7e5e3c30 1a6a",
    /* g */ "8a826010 8a2a08062484",
    /* h */ "0e00 0a6a8880",
    /* i */ "4a40 4e4d",
    /* j */ "5a523010 5e5d",
    /* k */ "0e00 8a04 4780",
    /* l */ "2e4e4060",
    /* m */ "000a3a4940 495a7a8980",
    /* n */ "000a6a8880",
    /* o */ "2002082a6a88826020",
    /* p */ "000a6a88866404",
    /* q */ "808a2a08062484",
    /* r */ "000a 073a8a",
    /* s */ "8a2a0807256583826000",
    /* t */ "3e325070 0a7a",
    /* u */ "0a0220808a",
    /* v */ "0a408a",
    /* w */ "0a2046608a",
    /* x */ "008a 0a80",
    /* y */ "0a062484 8a826010",
    /* z */ "0a8a0080",
    /* { */ "6e4c4927454260",
    /* | */ "4e40",
    /* } */ "2e4c4967454220",
    /* ~ */ "06286688",
};

double half_units(char digit) { return 0.5 * (digit >= 'a' ? digit - 'a' + 10 : digit - '0'); }

}  // namespace

std::vector<Stroke> letter(char c) {
  const auto drawing = kLetters[static_cast<std::size_t>(c - kFirstLetter)];
  std::vector<Stroke> out;
  for (std::size_t i = 0; i < drawing.size(); i += 2) {
    if (drawing[i] == ' ') ++i;
    if (i == 0 || drawing[i - 1] == ' ') out.emplace_back();
    out.back().emplace_back(half_units(drawing[i]), half_units(drawing[i + 1]));
  }
  return out;
}

}  // namespace tubecut::cutout
