#include "core/part/cut_edges.hpp"

#include <limits>
#include <utility>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"

namespace tubecut::part {

Result<void> check_left(const std::vector<WallEnds>& walls, double length) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : walls)
    for (const auto* nodes : {&a.phi, &b.phi})
      for (std::size_t i = 0; i < nodes->size() && !stops(i); ++i)
        least = std::min(least, b.at((*nodes)[i]).low - a.at((*nodes)[i]).high);
  if (least > 0.0) return {};
  return fail({.code = ErrorCode::member_consumed,
               .member = "target/length",
               .got = length,
               .limit = length - least,
               .unit = "mm",
               .hint = "the cuts of both ends meet; the limit is where they just touch"});
}

void carry(std::vector<Warning> warnings, std::string_view parent, std::vector<Warning>& out) {
  for (auto& w : under(parent, std::move(warnings))) out.push_back(std::move(w));
}

}  // namespace tubecut::part
