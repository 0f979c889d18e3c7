#include "api/formats/drawing/part_marks.hpp"

#include "api/catalog/post.hpp"
#include "api/formats/numbers.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {

namespace {

template <class Mark>
std::string by_hand(const Mark& mark, const std::string& round, const Post& post) {
  using Kind = part::Mark::Kind;
  const std::string what = mark.kind == Kind::datum_line ? "the datum line"
                           : mark.kind == Kind::partner  ? "partner " + mark.text
                           : mark.lettering              ? "the text " + mark.text + ", " +
                                                  post.length(mark.lettering->spec.height) +
                                                  " high, its base line"
                                            : "the name " + mark.text;
  const auto from = post.length_number(mark.z_from), to = post.length(mark.z_to);
  return "mark by hand: " + what + " at " + round +
         (mark.z_from == mark.z_to ? ", " + to : ", " + from + " to " + to) +
         " from the long point of the start";
}

}  // namespace

std::string text_in_words(const cutout::Lettering& text) {
  return "text " + text.spec.text + ", " + mm(text.spec.height) + " high" +
         (text.spec.turn == 0.0 ? "" : ", turned " + degrees(text.spec.turn)) +
         (text.spec.mirrored ? ", mirrored" : "");
}

std::string mark_by_hand(const part::Mark& mark, const Post& post) {
  return by_hand(mark, "phi " + number(mark.phi * kDegPerRad, Unit::deg) + " deg", post);
}

std::string mark_by_hand(const part::SectionMark& mark, const Post& post) {
  return by_hand(mark, "girth " + post.length(mark.s), post);
}

}  // namespace tubecut::api
