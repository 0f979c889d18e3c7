#include "core/frame/alike.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/frame/alike_form.hpp"
#include "core/frame/alike_match.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::frame {
namespace {

using detail::Form;
using detail::FormWall;
using detail::near_zero;
using detail::Side;

constexpr double kWritten = 1e6;       // lengths are compared to six decimals
constexpr double kAtEvent = 2e-9;      // rad: a phase this near an event may lie on either side
constexpr double kLeastJump = 1e-3;    // mm: less may be a kink of what differs
constexpr double kMissingStep = 1e-3;  // mm: requests state missing lengths to three decimals
// Maximum error of a mean over phases if the contour has corners and jumps.
constexpr double kMeanOff = 0.1, kMeanOffOfRadius = 0.01;  // mm; of the radius

/// Returns the texts that two alike shapes must share exactly; each list is sorted, because the
/// order has no meaning.
std::vector<std::string> key_of(const Shape& shape) {
  std::vector<std::string> out{shape.key};
  for (const auto* keys : {&shape.start, &shape.finish, &shape.holes, &shape.marks}) {
    auto sorted = *keys;
    std::ranges::sort(sorted);
    out.insert(out.end(), sorted.begin(), sorted.end());
    out.emplace_back();  // separates the lists
  }
  return out;
}

/// Returns for each phase how far apart in phase the events are that it lies between: beyond the
/// event of one line, and before that of the other. NaN if it lies between none.
std::vector<double> between_events(const FormWall::Line& one, const FormWall::Line& other) {
  const auto n = one.z.size();
  const double step = kTwoPi / static_cast<double>(n);
  std::vector<double> out(n, std::numeric_limits<double>::quiet_NaN());
  for (const double event : one.events)
    for (const double same : other.events) {
      const double apart = near_zero(same - event);
      if (!(std::abs(apart) < step)) continue;
      const auto k = std::llround((event + 0.5 * apart) / step);
      const double way = std::abs(near_zero(static_cast<double>(k) * step - event - 0.5 * apart));
      auto& known = out[static_cast<std::size_t>(k) % n];
      if (way <= 0.5 * std::abs(apart) + kAtEvent && !(known <= std::abs(apart)))
        known = std::abs(apart);
    }
  return out;
}

/// Compares as curves where one line has jumped at a phase and the other has not yet: they are as
/// far apart there as their jumps are around the tube, and along it as next to them.
void follow_jumps(const FormWall::Line& one, const FormWall::Line& other, std::vector<double>& r,
                  std::vector<double>& a) {
  const auto n = a.size();
  const auto apart = between_events(one, other);
  const auto neighbour = [&](std::size_t i, std::size_t step) {
    auto out = (i + step) % n;
    while (out != i && !std::isnan(apart[out])) out = (out + step) % n;
    return out;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isnan(apart[i])) continue;
    const double along = 0.5 * (a[neighbour(i, n - 1)] + a[neighbour(i, 1)]),
                 round = one.radius * apart[i];
    if (std::abs(a[i] - along) <= std::max(round, kLeastJump)) continue;
    a[i] = along;
    r[i] = round;
  }
}

/// Distances from points of one wall to those of another: around the tube and along it.
struct Ways {
  std::vector<double> round, along;
  double between = 0.0;  // additional distance possible between two phases

  /// Returns false when they have no points in common.
  bool add(const FormWall::Line& one, const FormWall::Line& other) {
    const auto n = one.z.size();
    if (other.z.size() != n || other.phi.size() != one.phi.size()) return false;
    std::vector<double> r(n, 0.0), a(n);
    for (std::size_t i = 0; i < n; ++i) {
      a[i] = one.z[i] - other.z[i];
      if (!one.phi.empty()) r[i] = one.radius * near_zero(one.phi[i] - other.phi[i]);
    }
    if (one.phi.empty()) follow_jumps(one, other, r, a);
    for (std::size_t i = 0; i < n; ++i) {
      const auto before = (i + n - 1) % n, after = (i + 1) % n;
      // For a smooth curve, an eighth of the second difference is enough.
      worsen(between, 0.25 * elementary::hypot(r[before] - 2.0 * r[i] + r[after],
                                               a[before] - 2.0 * a[i] + a[after]));
    }
    round.insert(round.end(), r.begin(), r.end());
    along.insert(along.end(), a.begin(), a.end());
    return true;
  }
  bool add(const std::vector<FormWall::Line>& one, const std::vector<FormWall::Line>& other) {
    bool same = one.size() == other.size();
    for (std::size_t i = 0; same && i < one.size(); ++i) same = add(one[i], other[i]);
    return same;
  }
  void add_mark(const part::Mark& one, const part::Mark& other, double radius, double turn) {
    round.push_back(radius * near_zero(one.phi + turn - other.phi));
    along.push_back(one.z_from - other.z_from);
  }

  /// Returns the move along the axis that minimises the largest distance, and that distance.
  [[nodiscard]] std::pair<double, double> fitted() const {
    const auto [least, most] = std::ranges::minmax(along);
    const double shift = 0.5 * (least + most);
    double worst = 0.0;
    for (std::size_t i = 0; i < along.size(); ++i)
      worsen(worst, elementary::hypot(round[i], along[i] - shift));
    return {shift, worst + between};
  }
};

}  // namespace

joint::MemberFrame Laid::stand(const joint::MemberFrame& own) const {
  auto out = own;
  if (shift != 0.0) out.origin += shift * own.rows.row(2).transpose();
  if (turn.rad() != 0.0) out.rows = math::turn_about_z(turn.rad()) * own.rows;
  return out;
}

/// The forms, and a cache of comparisons.
class Gatherer::Known {
 public:
  Known(std::span<const AskedPart> forms, std::span<const std::string> texts, double within)
      : texts_(texts.begin(), texts.end()), within_(std::max(within, kLeastAlike)) {
    for (const auto& asked : forms)
      forms_.push_back(asked.part == nullptr ? std::nullopt : detail::form_of(asked));
    walls_.resize(forms_.size());
  }

  Result<std::vector<AlikeGroup>> groups(std::span<const Shape> shapes);

 private:
  using Column = std::vector<std::size_t>;  // indices of shapes, holes or marks
  /// Two forms, the turn, and the matched holes and marks.
  using Pair = std::tuple<std::size_t, std::size_t, std::int64_t, Column, Column>;
  struct Fit {
    bool there = false;
    double shift = 0.0, differs = 0.0;
  };

  [[nodiscard]] double left(const Shape& shape) const {
    const auto& form = forms_[shape.form];
    return form ? form->left : std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] auto order(const Shape& shape) const {
    const auto& form = forms_[shape.form];
    const double mean = left(shape);
    const auto written = [](double value) { return std::round(value * kWritten); };
    return std::tuple(std::isnan(mean) ? 0.0 : written(mean),
                      form ? written(*form->part->target.length) : 0.0,
                      std::string_view(texts_[shape.form]));
  }
  /// Returns true if the lengths between both cuts permit that two are alike.
  [[nodiscard]] bool near(const Shape& a, const Shape& b) const {
    const auto& form = forms_[a.form];
    const double off = std::abs(left(a) - left(b));
    return !form || std::isnan(off) ||
           off <= 2.0 * within_ + kMeanOff + kMeanOffOfRadius * form->part->target.outer_radius;
  }

  void gather(std::span<const Shape> shapes, Column rest, std::vector<AlikeGroup>& out);
  std::optional<Laid> lay(const Shape& member, const Shape& by);
  Fit fit(const Side& member, const Side& by, const Laid& laid);

  std::vector<std::optional<Form>> forms_;
  std::vector<std::string> texts_;
  double within_;
  std::vector<std::optional<std::optional<FormWall>>>
      walls_;  // of each form, computed on first use
  std::map<Pair, Fit> fits_;
};

/// Compares every point of the member's turned wall with the same point of the other's wall.
Gatherer::Known::Fit Gatherer::Known::fit(const Side& member, const Side& by, const Laid& laid) {
  const Pair pair{member.shape.form, by.shape.form,
                  std::llround(laid.turn.rad() / detail::kSameTurn), laid.holes, laid.marks};
  if (const auto known = fits_.find(pair); known != fits_.end()) return known->second;
  auto& theirs = walls_[by.shape.form];
  if (!theirs) theirs = detail::wall_of(by.form, {});
  const auto make = [&]() -> Fit {
    if (!*theirs) return {};
    const auto own = detail::wall_of(member.form, laid.turn);
    Ways ways;
    if (!own || !ways.add(own->ends, (*theirs)->ends)) return {};
    for (std::size_t i = 0; i < own->holes.size(); ++i)
      if (!ways.add(own->holes[i], (*theirs)->holes[laid.holes[i]])) return {};
    for (std::size_t i = 0; i < laid.marks.size(); ++i)
      ways.add_mark(member.form.part->partners[i], by.form.part->partners[laid.marks[i]],
                    by.form.part->target.outer_radius, laid.turn.rad());
    const auto [shift, differs] = ways.fitted();
    return {true, shift, differs};
  };
  const auto out = make();
  if (!stopped()) fits_.emplace(pair, out);
  return out;
}

std::optional<Laid> Gatherer::Known::lay(const Shape& member, const Shape& by) {
  if (member.form == by.form && member.start == by.start && member.finish == by.finish &&
      member.holes == by.holes && member.marks == by.marks) {
    Laid same;
    for (const auto& [to, of] :
         {std::pair{&same.start, &by.start}, std::pair{&same.finish, &by.finish},
          std::pair{&same.holes, &by.holes}, std::pair{&same.marks, &by.marks}})
      for (std::size_t i = 0; i < of->size(); ++i) to->push_back(i);
    return same;
  }
  const auto& form = forms_[member.form];
  const auto& other = forms_[by.form];
  if (!form || !other || !near(member, by)) return std::nullopt;
  const Side one{*form, member}, two{*other, by};
  if (!one.whole() || !two.whole()) return std::nullopt;
  // Cut-outs are placed from the part's own start and datum, which a turn or a move would displace.
  const bool stands = member.has_cutouts;
  for (const double turn : stands ? std::vector{0.0} : detail::turns(one, two, within_)) {
    auto laid = detail::resembles(one, two, turn, within_);
    if (!laid || detail::missing_apart(member, by, *laid) > within_ + kMissingStep) continue;
    const auto found = fit(one, two, *laid);
    if (!found.there || !(found.differs <= within_)) continue;
    const double holes =
        stands ? std::abs(found.shift) + detail::square_holes_apart(*form, *other) : 0.0;
    if (holes > within_) continue;
    laid->shift = found.shift;
    laid->differs = std::max(found.differs, holes);
    return laid;
  }
  return std::nullopt;
}

/// Groups shapes that are near each other in length, given in their order.
void Gatherer::Known::gather(std::span<const Shape> shapes, Column rest,
                             std::vector<AlikeGroup>& out) {
  while (!rest.empty() && !stopped()) {
    AlikeGroup group{.by = rest[rest.size() / 2], .shapes = {}};
    Column others;
    for (const auto i : rest) {
      if (stopped()) return;
      if (auto laid = lay(shapes[i], shapes[group.by]))
        group.shapes.emplace_back(i, *std::move(laid));
      else
        others.push_back(i);
    }
    std::ranges::sort(group.shapes, {}, &std::pair<std::size_t, Laid>::first);
    out.push_back(std::move(group));
    rest = std::move(others);
  }
}

Result<std::vector<AlikeGroup>> Gatherer::Known::groups(std::span<const Shape> shapes) {
  std::map<std::vector<std::string>, Column> by_key;
  for (std::size_t i = 0; i < shapes.size(); ++i) by_key[key_of(shapes[i])].push_back(i);
  std::vector<AlikeGroup> out;
  for (auto& [key, all] : by_key) {
    std::ranges::stable_sort(all, {}, [&](std::size_t i) { return order(shapes[i]); });
    Column chain;
    for (const auto i : all) {
      if (!chain.empty() && !near(shapes[chain.back()], shapes[i]))
        gather(shapes, std::exchange(chain, {}), out);
      chain.push_back(i);
    }
    gather(shapes, std::move(chain), out);
    if (stopped()) return fail({.code = ErrorCode::cancelled});
  }
  return out;
}

Gatherer::Gatherer(std::span<const AskedPart> forms, std::span<const std::string> texts,
                   double within)
    : known_(std::make_unique<Known>(forms, texts, within)) {}
Gatherer::~Gatherer() = default;

Result<std::vector<AlikeGroup>> Gatherer::groups(std::span<const Shape> shapes) {
  return known_->groups(shapes);
}

}  // namespace tubecut::frame
