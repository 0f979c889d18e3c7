#include "core/bevel/hole/hole_cause.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/elementary.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kMostLean = 89.0 * kRadPerDeg;  // maximum of any torch's range
constexpr std::array kLess{5.0, 15.0, 30.0};     // deg, by which a cause is reduced

const char* beyond_hint(Tilt tilt) {
  switch (tilt) {
    case Tilt::axial:
      return "a swing in only the axial plane cannot keep the hole's wall off the branch here; "
             "tilt free can";
    case Tilt::free:
      return "the surfaces are too nearly tangent here";
    case Tilt::none:
      return "a head that does not tilt cannot keep the hole's wall off the branch here: its axis "
             "may pass the chord's by at most the branch's radius; tilt free cuts more, but preset "
             "tube_laser has none";
  }
  return "";
}

class Causes {
 public:
  Causes(const HoleSpec& spec, double lean, const std::function<bool(const HoleSpec&)>& can_be_cut)
      : spec_(spec), lean_(lean), can_be_cut_(can_be_cut) {}

  [[nodiscard]] std::optional<Issue> groove() const {
    auto changed = spec_;
    auto* const fixed = std::get_if<FixedGroove>(&changed.groove);
    auto* const half = std::get_if<HalfDihedral>(&changed.groove);
    if (spec_.kind == JointKind::set_on || (fixed == nullptr && half == nullptr))
      return std::nullopt;
    auto& angle = fixed != nullptr ? fixed->angle : half->cap;
    const double asked = angle.deg();
    for (const double less : kLess) {
      if (!(asked - less > 0.0)) break;
      angle = Angle::deg(asked - less);
      if (can_be_cut_(changed))
        return too_much(fixed != nullptr ? "groove/angle" : "groove/cap", asked, asked - less);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Issue> range(bool max) const {
    if (!max && spec_.tilt != Tilt::axial) return std::nullopt;  // only its largest lean counts
    auto changed = spec_;
    auto& end = max ? changed.torch.max : changed.torch.min;
    const double asked = end.deg(), most = std::min(std::abs(asked), lean_ * kDegPerRad);
    for (const double less : kLess) {
      if (!(most - less > 0.0)) break;
      const double limit = max ? most - less : less - most;
      end = Angle::deg(limit);
      if (can_be_cut_(changed)) return too_much(max ? "torch/max" : "torch/min", asked, limit);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Issue> tilt() const {
    if (spec_.tilt != Tilt::free) return std::nullopt;
    for (const auto& [other, name] : {std::pair{Tilt::axial, "axial"}, {Tilt::none, "none"}}) {
      auto changed = spec_;
      changed.tilt = other;
      if (can_be_cut_(changed))
        return Issue{.code = ErrorCode::unsupported_combination,
                     .member = "tilt",
                     .limit = std::string(name),
                     .hint = why() + "tilt " + name + " can be cut"};
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::string why() const {
    return "the torch would lean up to " + brief(lean_ * kDegPerRad) +
           " deg, where a beam as wide as the kerf takes from the finished part; ";
  }
  [[nodiscard]] Issue too_much(const char* member, double got, double limit) const {
    return {.code = ErrorCode::out_of_range,
            .member = member,
            .got = got,
            .limit = limit,
            .unit = "deg",
            .hint = why() + brief(limit) + " deg can be cut"};
  }

  const HoleSpec& spec_;
  double lean_;
  const std::function<bool(const HoleSpec&)>& can_be_cut_;
};

}  // namespace

double furthest_lean(const Hole& hole) {
  double out = 0.0;
  for (std::size_t i = 0; i < hole.b.size(); ++i)
    out = std::max(out, elementary::atan(elementary::hypot(elementary::tan(hole.b[i]),
                                                           elementary::tan(hole.a[i]))));
  return out;
}

Issue beyond_torch(const HoleSpec& spec, Intervals phases, double needs) {
  // A wider range of the torch helps up to kMostLean; beyond it only another tilt or another branch
  // does.
  const bool by_range = std::abs(needs) <= kMostLean, low = by_range && needs < 0.0;
  Issue out{.code = ErrorCode::torch_range,
            .member = low                       ? "torch/min"
                      : by_range                ? "torch/max"
                      : spec.tilt == Tilt::free ? "branch"
                                                : "tilt",
            .got = std::move(phases),
            .limit = (low ? spec.torch.min : spec.torch.max).deg(),
            .unit = "deg",
            .hint = beyond_hint(spec.tilt)};
  if (by_range && needs != 0.0)
    out.hint += ", or a torch that leans " + brief(needs * kDegPerRad) + " deg";
  return out;
}

std::optional<Issue> first_cause(const HoleSpec& spec, double lean,
                                 const std::function<bool(const HoleSpec&)>& can_be_cut) {
  const Causes causes(spec, lean, can_be_cut);
  if (auto out = causes.groove()) return out;
  if (auto out = causes.range(true)) return out;
  if (auto out = causes.range(false)) return out;
  return causes.tilt();
}

}  // namespace tubecut::bevel
