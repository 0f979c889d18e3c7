#include "core/frame/alike_match.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.hpp"

namespace tubecut::frame::detail {
namespace {

constexpr double kResembles = 1.0;  // mm: tolerance at a few points, before the walls are compared
constexpr double kHasASide =
    1.0;  // mm: height difference of a partner that defines a side, by which a part is turned
constexpr std::size_t kRimPhases =
    3;  // the rim of a partner may hit one part and miss the other at this many phases

/// Returns the height of one partner above another; empty when the height differences are not
/// constant.
std::optional<double> higher_by(const PartnerHeights& one, const PartnerHeights& other,
                                double within) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  std::size_t on_one = 0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    if (one[k].has_value() != other[k].has_value()) ++on_one;
    if (!one[k] || !other[k]) continue;
    least = std::min(least, *one[k] - *other[k]);
    most = std::max(most, *one[k] - *other[k]);
  }
  if (on_one > kRimPhases || most - least > within) return std::nullopt;
  return most < least ? 0.0 : 0.5 * (most + least);  // 0 if both miss all generators
}

/// Returns the point of a branch's axis that is nearest to the tube's.
Eigen::Vector3d foot(const cutout::Branch& branch) {
  const Eigen::Vector3d& d = branch.axis.direction;
  const double across = d.head<2>().squaredNorm();
  const double along = across > 0.0 ? -branch.axis.point.head<2>().dot(d.head<2>()) / across : 0.0;
  return branch.axis.point + along * d;
}

/// Returns how far the surfaces of two branches are apart at most within the tube's reach.
double branches_apart(const cutout::Branch& one, const cutout::Branch& other, double tube) {
  const double reach = one.section ? one.section->reach() : one.radius;
  const Eigen::Vector3d u = one.axis.direction.normalized();
  const Eigen::Vector3d off = foot(other) - foot(one);
  const double turned = (other.axis.direction.normalized() - u).norm();
  const auto across = [&](const Eigen::Vector3d& up) {
    return Eigen::Vector3d(up - up.dot(u) * u).normalized();
  };
  const double twisted = one.section ? (across(other.up) - across(one.up)).norm() : 0.0;
  return (off - off.dot(u) * u).norm() + turned * 2.0 * (tube + reach) + twisted * reach;
}

/// How the partners of one end match those of another: the index of each match.
struct Answered {
  std::vector<std::size_t> which;
  double higher = 0.0;  // than the other
};

std::optional<Answered> answer(const FormEnd& end, const std::vector<std::string>& keys,
                               const FormEnd& to, const std::vector<std::string>& to_keys,
                               double radius, double turned, double within) {
  Answered out{.which = std::vector<std::size_t>(keys.size()), .higher = 0.0};
  std::vector<bool> taken(to_keys.size(), false);
  std::vector<PartnerHeights> others;
  for (std::size_t j = 0; j < to_keys.size(); ++j) others.push_back(to.heights(j, radius, 0.0));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto seen = end.heights(i, radius, turned);
    std::optional<double> nearest;
    for (std::size_t j = 0; j < to_keys.size(); ++j) {
      if (taken[j] || keys[i] != to_keys[j]) continue;
      const auto higher = higher_by(seen, others[j], within);
      if (!higher || (i > 0 && std::abs(*higher - out.higher) > within)) continue;
      if (nearest && std::abs(*nearest) <= std::abs(*higher)) continue;
      nearest = higher;
      out.which[i] = j;
    }
    if (!nearest) return std::nullopt;
    if (i == 0) out.higher = *nearest;
    taken[out.which[i]] = true;
  }
  return out;
}

/// The position of a hole or a mark on the tube.
struct Spot {
  double phi = 0.0, z = 0.0, offset = 0.0, inclination = 0.0;
};

std::vector<Spot> holes_of(const Form& form) {
  std::vector<Spot> out;
  for (const auto& b : form.holes)
    out.push_back({b.clocking.rad(), b.height, b.offset, b.inclination.rad()});
  return out;
}
std::vector<Spot> marks_of(const Form& form) {
  std::vector<Spot> out;
  for (const auto& m : form.part->partners) out.push_back({m.phi, m.z_from, 0.0, 0.0});
  return out;
}

/// Finds for each spot the nearest match among the others.
std::optional<std::vector<std::size_t>> answer(const std::vector<Spot>& spots,
                                               const std::vector<std::string>& keys,
                                               const std::vector<Spot>& to,
                                               const std::vector<std::string>& to_keys,
                                               double radius, double turn, double shift,
                                               double within) {
  std::vector<std::size_t> out(spots.size());
  std::vector<bool> taken(to.size(), false);
  for (std::size_t i = 0; i < spots.size(); ++i) {
    double nearest = within;
    bool found = false;
    for (std::size_t j = 0; j < to.size(); ++j) {
      if (taken[j] || keys[i] != to_keys[j]) continue;
      const double off = worst_of({std::abs(spots[i].z - shift - to[j].z),
                                   radius * std::abs(near_zero(spots[i].phi + turn - to[j].phi)),
                                   std::abs(spots[i].offset - to[j].offset),
                                   radius * std::abs(spots[i].inclination - to[j].inclination)});
      if (!(off <= nearest)) continue;
      nearest = off;
      found = true;
      out[i] = j;
    }
    if (!found) return std::nullopt;
    taken[out[i]] = true;
  }
  return out;
}

/// Returns the sides of a part by which it may be turned onto another, in the start's frame: of the
/// partners with this key, or of its holes or marks.
std::vector<double> sides_of(const Side& side, int room, const std::string& key) {
  std::vector<double> out;
  const auto add_end = [&](const FormEnd& end, const std::vector<std::string>& keys, double sign) {
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (keys[i] == key && end.perpendicular[i]) out.push_back(sign * *end.perpendicular[i]);
  };
  const auto add_spots = [&](const std::vector<Spot>& spots, const std::vector<std::string>& keys) {
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (keys[i] == key) out.push_back(spots[i].phi);
  };
  if (room == 0) add_end(side.form.start, side.shape.start, 1.0);
  if (room == 1) add_end(side.form.finish, side.shape.finish, -1.0);
  if (room == 2) add_spots(holes_of(side.form), side.shape.holes);
  if (room == 3) add_spots(marks_of(side.form), side.shape.marks);
  return out;
}

/// The side by which a part is turned: of the first partner that is not square to the tube, else of
/// a hole or mark.
struct Handle {
  int room = -1;  // -1: no turn is needed
  std::string key;
  double phi = 0.0;
};
Handle handle_of(const Side& side) {
  for (const int room : {0, 1}) {
    const auto& end = room == 0 ? side.form.start : side.form.finish;
    const auto& keys = room == 0 ? side.shape.start : side.shape.finish;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (!end.perpendicular[i]) continue;
      const auto heights = end.heights(i, side.form.middle(), 0.0);
      double least = std::numeric_limits<double>::infinity(), most = -least;
      bool all = true;
      for (const auto& z : heights) {
        all = all && z.has_value();
        if (z) least = std::min(least, *z), most = std::max(most, *z);
      }
      if (all && most - least < kHasASide) continue;
      return {room, keys[i], (room == 0 ? 1.0 : -1.0) * *end.perpendicular[i]};
    }
  }
  if (!side.shape.holes.empty())
    return {2, side.shape.holes.front(), holes_of(side.form).front().phi};
  if (!side.shape.marks.empty())
    return {3, side.shape.marks.front(), marks_of(side.form).front().phi};
  return {};
}

/// Returns the rotations that a section permits, of those near one.
std::vector<double> permitted(const std::vector<double>& turns, const section::Section& section) {
  constexpr double kNear = 0.01;  // rad
  const double step = section.height == section.width ? 0.5 * kPi : kPi;
  std::vector<double> out;
  for (const double turn : turns) {
    const double exact = step * std::round(turn / step);
    const bool there = std::ranges::any_of(
        out, [&](double one) { return std::abs(near_zero(one - exact)) < kNear; });
    if (std::abs(turn - exact) < kNear && !there) out.push_back(near_zero(exact));
  }
  return out;
}

}  // namespace

bool Side::whole() const {
  return shape.start.size() == form.start.partners.size() &&
         shape.finish.size() == form.finish.partners.size() &&
         shape.holes.size() == form.holes.size() &&
         shape.marks.size() == form.part->partners.size();
}

double near_zero(double angle) { return angle - kTwoPi * std::round(angle / kTwoPi); }

std::vector<double> turns(const Side& member, const Side& by, double within) {
  const double same = std::max(kSameTurn, 0.1 * within / by.form.part->target.outer_radius);
  const auto handle = handle_of(by);
  if (handle.room < 0) return {0.0};
  std::vector<double> out;
  for (const double phi : sides_of(member, handle.room, handle.key))
    for (const double half : {0.0, kPi}) {
      const double turn = near_zero(handle.phi - phi + half);
      const bool there = std::ranges::any_of(
          out, [&](double one) { return std::abs(near_zero(one - turn)) < same; });
      if (!there) out.push_back(turn);
    }
  return by.form.section ? permitted(out, *by.form.section) : out;
}

std::optional<Laid> resembles(const Side& member, const Side& by, double turn, double within) {
  const double radius = by.form.middle();
  const double coarse = kResembles + 10.0 * within;
  auto start = answer(member.form.start, member.shape.start, by.form.start, by.shape.start, radius,
                      turn, coarse);
  if (!start) return std::nullopt;
  auto finish = answer(member.form.finish, member.shape.finish, by.form.finish, by.shape.finish,
                       radius, -turn, coarse);
  if (!finish) return std::nullopt;
  const double longer = *member.form.part->target.length - *by.form.part->target.length;
  if (!(std::abs(longer - finish->higher - start->higher) <= coarse)) return std::nullopt;
  const double outer = by.form.part->target.outer_radius;
  auto holes = answer(holes_of(member.form), member.shape.holes, holes_of(by.form), by.shape.holes,
                      outer, turn, start->higher, coarse);
  if (!holes) return std::nullopt;
  auto marks = answer(marks_of(member.form), member.shape.marks, marks_of(by.form), by.shape.marks,
                      outer, turn, start->higher, coarse);
  if (!marks) return std::nullopt;
  return Laid{.turn = Angle::rad(turn),
              .shift = start->higher,
              .differs = 0.0,
              .start = std::move(start->which),
              .finish = std::move(finish->which),
              .holes = *std::move(holes),
              .marks = *std::move(marks)};
}

double missing_apart(const Shape& member, const Shape& by, const Laid& laid) {
  double worst = 0.0;
  for (std::size_t i = 0; i < laid.start.size(); ++i)
    worsen(worst, std::abs(member.start_missing[i] - by.start_missing[laid.start[i]]));
  for (std::size_t i = 0; i < laid.finish.size(); ++i)
    worsen(worst, std::abs(member.finish_missing[i] - by.finish_missing[laid.finish[i]]));
  return worst;
}

double square_holes_apart(const Form& one, const Form& other) {
  const auto& holes = one.part->square_holes;
  const auto& others = other.part->square_holes;
  if (holes.size() != others.size()) return std::numeric_limits<double>::infinity();
  const double tube = one.section != nullptr ? one.section->reach() : one.part->target.outer_radius;
  double worst = 0.0;
  for (std::size_t i = 0; i < holes.size(); ++i)
    worsen(worst, branches_apart(holes[i].branch, others[i].branch, tube));
  return worst;
}

}  // namespace tubecut::frame::detail
