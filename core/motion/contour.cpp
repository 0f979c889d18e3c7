#include "core/motion/contour.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/elementary.hpp"

namespace tubecut::motion {
namespace {

constexpr double kBack = 3e-3;     // rad, of a turn by half a round
constexpr double kClosing = 1e-6;  // mm and rad between the two ends
constexpr double kMostBevel = 85.0 * kRadPerDeg + 1e-12;
constexpr double kMostPhi = 3600.0 * kRadPerDeg;
constexpr double kMostLength = 1e6;  // mm

Result<void> check_columns(const Contour& c) {
  const std::size_t n = c.phi.size();
  const auto sized = [&](std::size_t got, bool may_be_empty) {
    return got == n || (may_be_empty && got == 0);
  };
  if (n < 3) {
    return fail({ErrorCode::wrong_count, "contour/phi", static_cast<double>(n), 3.0, {}, {}});
  }
  if (!sized(c.z.size(), false))
    return fail({.code = ErrorCode::wrong_count, .member = "contour/z"});
  if (!sized(c.b.size(), false))
    return fail({.code = ErrorCode::wrong_count, .member = "contour/b"});
  if (!sized(c.corner.size(), true)) {
    return fail({.code = ErrorCode::wrong_count, .member = "contour/corner"});
  }
  if (!sized(c.beam.size(), true)) {
    return fail({.code = ErrorCode::wrong_count, .member = "contour/beam"});
  }
  if (!(c.outer_radius > 0.0 && c.outer_radius < kMostLength)) {
    return fail({.code = ErrorCode::bad_number, .member = "contour/outer_radius"});
  }
  if (!(c.wall >= 0.0 && c.wall < c.outer_radius)) {
    return fail({.code = ErrorCode::bad_number, .member = "contour/wall"});
  }
  return {};
}

std::string member(const char* column, std::size_t i) {
  return std::string("contour/") + column + "/" + std::to_string(i);
}

Result<void> check_numbers(const Contour& c) {
  for (std::size_t i = 0; i < c.phi.size(); ++i) {
    if (!(std::abs(c.phi[i]) <= kMostPhi)) {
      return fail({.code = ErrorCode::bad_number, .member = member("phi", i)});
    }
    if (!(std::abs(c.z[i]) <= kMostLength)) {
      return fail({.code = ErrorCode::bad_number, .member = member("z", i)});
    }
    if (!std::isfinite(c.b[i])) {
      return fail({.code = ErrorCode::bad_number, .member = member("b", i)});
    }
    if (std::abs(c.b[i]) > kMostBevel) {
      return fail(
          {ErrorCode::angle_out_of_range, member("b", i), c.b[i] * kDegPerRad, 85.0, "deg", {}});
    }
    if (!c.beam.empty() && !(c.beam[i] >= 0.0 && c.beam[i] <= kMostLength)) {
      return fail({.code = ErrorCode::bad_number, .member = member("beam", i)});
    }
  }
  return {};
}

std::vector<ContourPoint> rows(const Contour& c) {
  std::vector<ContourPoint> points(c.phi.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double beam = c.beam.empty() ? c.wall / elementary::cos(c.b[i]) : c.beam[i];
    points[i] = {c.phi[i], c.z[i], c.b[i], !c.corner.empty() && c.corner[i], beam};
  }
  return points;
}

bool agree(const ContourPoint& a, const ContourPoint& b) {
  return std::abs(a.z - b.z) <= kClosing && std::abs(a.b - b.b) <= kClosing;
}

double largest_phi_step(const std::vector<ContourPoint>& points) {
  double largest = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    largest = std::max(largest, std::abs(points[i].phi - points[i - 1].phi));
  }
  return largest;
}

/// Makes the end the first point one turn on, appending it where a whole turn comes open; `gap` is
/// what is missing to it, in rad of phi.
Result<void> close(Track& t, double gap) {
  auto& points = t.points;
  const bool there = std::abs(gap) <= kClosing;
  if (there && !agree(points.front(), points.back())) {
    return fail({ErrorCode::not_closed, "contour", points.back().z - points.front().z, kClosing,
                 "mm", "the ends differ in z or b"});
  }
  const double most = t.turns == 0 ? 0.0 : 3.0 * largest_phi_step(points);
  if (!there && (gap < -kClosing || gap > most + kClosing)) {
    return fail({ErrorCode::not_closed, "contour", gap * kDegPerRad, 0.0, "deg",
                 "phi misses the whole turn by this"});
  }
  ContourPoint end = points.front();
  end.phi += kTwoPi * t.turns;
  if (there) {
    points.back() = end;
  } else {
    points.push_back(end);
  }
  return {};
}

Result<void> close(Track& t, Scrap scrap) {
  const double span = t.points.back().phi - t.points.front().phi;
  if (scrap == Scrap::inside) {
    t.turns = 0;
    return close(t, std::abs(span));
  }
  t.turns = span < 0.0 ? -1 : 1;
  return close(t, kTwoPi - std::abs(span));
}

Result<void> check_duplicates(const Track& t) {
  for (std::size_t i = 1; i < t.points.size(); ++i) {
    const ContourPoint& a = t.points[i - 1];
    const ContourPoint& b = t.points[i];
    if (a.phi == b.phi && a.z == b.z && a.b == b.b) {
      return fail(
          {ErrorCode::duplicate_point, member("phi", i), a.phi * kDegPerRad, {}, "deg", {}});
    }
  }
  return {};
}

/// A track that runs straight back over itself: on the way back nobody can tell, from where the tip
/// is, which of the two it is on.
Result<void> check_turns(const Track& t) {
  struct Way {
    double x, z;
    std::size_t from;
  };
  std::vector<Way> ways;  // of the tip: a swing in place is none
  for (std::size_t i = 1; i < t.points.size(); ++i) {
    const ContourPoint& a = t.points[i - 1];
    const ContourPoint& b = t.points[i];
    if (a.phi != b.phi || a.z != b.z)
      ways.push_back({t.radius * (b.phi - a.phi), b.z - a.z, i - 1});
  }
  for (std::size_t k = t.closed ? 0 : 1; k < ways.size(); ++k) {  // closed: across the join too
    const Way& there = ways[(k + ways.size() - 1) % ways.size()];
    const Way& on = ways[k];
    const double along = there.x * on.x + there.z * on.z;
    if (along < 0.0 && std::abs(there.x * on.z - there.z * on.x) <= kBack * -along)
      return fail({.code = ErrorCode::turns_back,
                   .member = member("phi", on.from),
                   .got = t.points[on.from].phi * kDegPerRad,
                   .unit = "deg"});
  }
  return {};
}

}  // namespace

double Track::tip_step(std::size_t from, std::size_t to) const {
  return elementary::hypot(radius * (points[to].phi - points[from].phi),
                           points[to].z - points[from].z);
}

int Track::orientation() const {
  if (turns != 0) return turns;
  if (!closed) return points.back().phi < points.front().phi ? -1 : 1;
  double twice_area = 0.0;
  const ContourPoint& o = points.front();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const ContourPoint& a = points[i - 1];
    const ContourPoint& b = points[i];
    twice_area += (a.phi - o.phi) * (b.z - o.z) - (b.phi - o.phi) * (a.z - o.z);
  }
  return twice_area < 0.0 ? -1 : 1;
}

Result<Track> track(const Contour& contour) {
  if (auto ok = check_columns(contour); !ok) return tl::unexpected<Error>(ok.error());
  if (auto ok = check_numbers(contour); !ok) return tl::unexpected<Error>(ok.error());
  Track t{rows(contour), contour.radius(), contour.closed, 0};
  if (t.closed) {
    if (auto ok = close(t, contour.scrap); !ok) return tl::unexpected<Error>(ok.error());
  }
  if (auto ok = check_duplicates(t); !ok) return tl::unexpected<Error>(ok.error());
  if (auto ok = check_turns(t); !ok) return tl::unexpected<Error>(ok.error());
  return t;
}

Contour as_machine_counts(Contour contour, BPositive b_positive) {
  if (b_positive == BPositive::outer_edge_to_waste) {
    for (double& b : contour.b) b = -b;
  }
  return contour;
}

}  // namespace tubecut::motion
