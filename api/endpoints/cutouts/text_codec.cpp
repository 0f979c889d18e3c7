#include "api/endpoints/cutouts/text_codec.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include "api/endpoints/section_bevel_table.hpp"
#include "api/wire/text_encoding.hpp"

namespace tubecut::api {
namespace {

constexpr Range kLetterHeight{.min = 2.0, .max = 100.0};  // mm
constexpr Range kBaseLineDeg{.min = -360.0, .max = 360.0};

/// Reads letters of the font.
std::string decode_letters(Reader& in) {
  auto out = in.text("text", cutout::kLongestText);
  const auto strange = std::ranges::find_if_not(out, cutout::has_letter);
  if (strange == out.end()) return out;
  std::string_view rest(out);
  rest.remove_prefix(static_cast<std::size_t>(strange - out.begin()));
  const auto whole = rest;
  (void)take_character(rest);
  const std::string letter(whole.substr(0, whole.size() - rest.size()));
  const auto spelled = in_ascii(out);
  in.issue({.code = ErrorCode::bad_text,
            .pointer = "text",
            .got = Json{letter},
            .limit = Json{"printable ASCII"},
            .hint = "the font has no letter for this character; " +
                    (spelled ? "write \"" + *spelled + "\"" : "leave it out")});
  return {};
}

cutout::TextSpec decode_text_mark(Reader& in, const AnchorTube& tube, std::set<std::string>& ids) {
  cutout::TextSpec out{.id = decode_own_id(in, ids, "another text has it")};
  out.at = in.object("at", [&](Reader& a) { return decode_anchor(a, tube); });
  out.turn = in.angle("angle_deg", kBaseLineDeg, Angle{}).rad();
  out.text = decode_letters(in);
  out.height = in.number("height_mm", kLetterHeight);
  out.mirrored = in.flag("mirrored", false);
  in.note("over_corner");
  if (tube.sure && tube.section == nullptr)
    refuse_fields(in, {"over_corner"}, "a round tube has no corners; remove it");
  else if (in.has("over_corner"))
    out.over_corner = in.flag("over_corner");
  return out;
}

}  // namespace

std::vector<cutout::TextSpec> decode_texts(Reader& in, const AnchorTube& tube) {
  in.note("texts");
  if (!in.has("texts")) return {};
  std::set<std::string> ids;
  return in.array("texts", {.min = 0, .max = cutout::kMostTexts},
                  [&](Reader& t) { return decode_text_mark(t, tube, ids); });
}

}  // namespace tubecut::api
