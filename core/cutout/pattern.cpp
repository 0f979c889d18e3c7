#include "core/cutout/pattern.hpp"

#include <cmath>
#include <string_view>

#include "core/base/angle.hpp"
#include "core/base/try.hpp"

namespace tubecut::cutout {
namespace {

constexpr double kSamePlace = 1e-9;  // rad

/// Equal steps round the tube must not come onto an earlier one after whole turns; `every`: how
/// many steps until one begins at the same place along the tube again.
Result<void> check_turn(int count, double turn, const std::string& member, int every = 1) {
  for (int step = every; step < count; step += every)
    if (std::abs(std::remainder(step * turn, kTwoPi)) < kSamePlace)
      return fail({.code = ErrorCode::pattern_wraps,
                   .member = member,
                   .got = static_cast<double>(count),
                   .limit = static_cast<double>(step),
                   .hint = "with this pitch more lie on each other"});
  return {};
}

/// Errors of the inner pattern, at its own fields.
Error in_each(Error error) {
  constexpr std::string_view kPattern = "pattern";
  for (auto& issue : error.issues) issue.member.insert(kPattern.size(), "/each");
  return error;
}

struct Steps {
  Result<std::vector<Step>> operator()(const Once&) const { return std::vector<Step>{{}}; }
  Result<std::vector<Step>> operator()(const Linear& p) const {
    // Steps along the tube too never come back.
    if (p.pitch == 0.0) {
      TRY(check_turn(p.count, p.turn, "pattern/count"));
    }
    std::vector<Step> out;
    for (int i = 0; i < p.count; ++i)
      out.push_back({"." + std::to_string(i), i * p.pitch, i * p.turn, {}});
    return out;
  }
  Result<std::vector<Step>> operator()(const Round& p) const {
    return (*this)(Linear{.count = p.count, .turn = p.turn});
  }
  /// A face's number less 1 comes first in a name.
  Result<std::vector<Step>> operator()(const Faces& p) const {
    const auto made = std::visit(*this, p.each);
    if (!made) return tl::unexpected(in_each(made.error()));
    const auto& each = *made;
    std::vector<Step> out;
    for (const int face : p.faces)
      for (const auto& one : each)
        out.push_back({"." + std::to_string(face - 1) + one.suffix, one.along, one.turn, face});
    return out;
  }
  Result<std::vector<Step>> operator()(const Grid& p) const {
    const bool staggered = p.stagger == Grid::Stagger::along && p.offset != 0.0;
    TRY(check_turn(p.round, p.turn, "pattern/round/count", staggered ? 2 : 1));
    const bool closed = std::abs(p.round * std::abs(p.turn) - kTwoPi) < kSamePlace;
    if (closed && p.stagger == Grid::Stagger::along && p.round % 2 != 0)
      return fail({.code = ErrorCode::pattern_wraps,
                   .member = "pattern/round/count",
                   .got = static_cast<double>(p.round),
                   .limit = static_cast<double>(p.round - 1),
                   .hint = "all round, staggered rows are even in number"});
    std::vector<Step> out;
    for (int j = 0; j < p.round; ++j)
      for (int i = 0; i < p.along; ++i) {
        const double along = p.stagger == Grid::Stagger::along && j % 2 != 0 ? p.offset : 0.0;
        const double round = p.stagger == Grid::Stagger::round && i % 2 != 0 ? p.offset : 0.0;
        out.push_back({"." + std::to_string(i) + "." + std::to_string(j),
                       i * p.pitch + along,
                       j * p.turn + round,
                       {}});
      }
    return out;
  }
};

struct Count {
  std::size_t operator()(const Once&) const { return 1; }
  std::size_t operator()(const Linear& p) const { return static_cast<std::size_t>(p.count); }
  std::size_t operator()(const Round& p) const { return static_cast<std::size_t>(p.count); }
  std::size_t operator()(const Grid& p) const {
    return static_cast<std::size_t>(p.along) * static_cast<std::size_t>(p.round);
  }
  std::size_t operator()(const Faces& p) const {
    return p.faces.size() * std::visit(*this, p.each);
  }
};

}  // namespace

std::size_t count_of(const Pattern& pattern) { return std::visit(Count{}, pattern); }

Result<std::vector<Step>> steps(const Pattern& pattern) { return std::visit(Steps{}, pattern); }

}  // namespace tubecut::cutout
