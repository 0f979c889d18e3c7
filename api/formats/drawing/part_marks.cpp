#include "api/formats/drawing/part_marks.hpp"

#include "api/catalog/post.hpp"
#include "api/formats/numbers.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {

std::string mark_by_hand(const part::Mark& mark, const Post& post) {
  const std::string what = mark.kind == part::Mark::Kind::datum_line ? "the datum line"
                           : mark.kind == part::Mark::Kind::partner  ? "partner " + mark.text
                                                                     : "the name " + mark.text;
  const auto from = post.length_number(mark.z_from), to = post.length(mark.z_to);
  return "mark by hand: " + what + " at phi " + number(mark.phi * kDegPerRad, Unit::deg) + " deg" +
         (mark.z_from == mark.z_to ? ", " + to : ", " + from + " to " + to) +
         " from the long point of the start";
}

}  // namespace tubecut::api
