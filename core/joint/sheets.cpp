#include "core/joint/sheets.hpp"

#include <algorithm>
#include <cmath>

#include "core/math/search.hpp"

namespace tubecut::joint {
namespace {

constexpr int kScan = 720;
constexpr double kUpright = 1e-9;  // a face as steep as that is met only at its corners

Sheets plane_sheets(const PreparedPlane& plane, double rho) {
  const double x = rho * plane.slope_x;
  const double y = rho * plane.slope_y;
  return {Trig<1>::first_order(plane.height, x, y), {}, rho + std::abs(x) + std::abs(y), false};
}

Sheets tube_sheets(const PreparedTube& t, double rho) {
  const double tilt = rho * t.cos_inclination / t.sin_inclination;
  const auto across = Trig<1>::first_order(t.offset, rho * t.cos_clocking, rho * t.sin_clocking);
  const auto radius = Trig<1>::first_order(t.radius, 0.0, 0.0);
  const double scale = 1.0 / (t.sin_inclination * t.sin_inclination);
  return {Trig<1>::first_order(t.height, tilt * t.sin_clocking, -tilt * t.cos_clocking),
          scale * ((radius - across) * (radius + across)), (t.radius + rho) / t.sin_inclination,
          true};
}

/// A component of the generator's foot in the partner's frame, over phi.
Trig<1> component(const ShapeFrame& frame, const Eigen::Vector3d& along, double rho) {
  const Eigen::Vector3d global = frame.rows.transpose() * along;
  return Trig<1>::first_order(-global.dot(frame.point), rho * global.x(), rho * global.y());
}

Trig<1> constant(double value) { return Trig<1>::first_order(value, 0.0, 0.0); }

/// The generator across the partner's axis, seen along and beside its own direction there.
struct Crossing {
  double across;  // length of the rise across the axis
  Trig<1> along, beside, axial;
};

Crossing crossing(const ShapeFrame& frame, double rho) {
  const auto& w = frame.rise;
  const double wp = std::sqrt(w.x() * w.x() + w.y() * w.y());
  return {wp, component(frame, {w.x() / wp, w.y() / wp, 0.0}, rho),
          component(frame, {w.y() / wp, -w.x() / wp, 0.0}, rho),
          component(frame, {0.0, 0.0, 1.0}, rho)};
}

Sheets cone_sheets(const PreparedCone& cone, double rho) {
  const auto c = crossing(cone.frame, rho);
  const double dr = cone.slope * cone.frame.rise.z();
  const double a = (c.across - dr) * (c.across + dr);
  const auto radius = constant(cone.radius) + cone.slope * c.axial;
  const auto rest = c.across * radius - dr * c.along;
  return {(1.0 / a) * (dr * radius - c.across * c.along),
          (1.0 / (a * a)) * (rest * rest - a * (c.beside * c.beside)),
          (std::abs(cone.radius) + rho) / shape_sine(cone), true};
}

std::vector<Sheets> box_sheets(const PreparedBox& box, double rho) {
  std::vector<Sheets> out;
  const auto c = crossing(box.frame, rho);
  const auto& w = box.frame.rise;
  const Eigen::Vector2d half(box.half_width, box.half_height);
  const double size = (half.sum() + rho) / c.across;
  for (const Eigen::Index i : {0, 1}) {
    if (std::abs(w[i]) < kUpright) continue;
    const auto foot = component(box.frame, Eigen::Vector3d::Unit(i), rho);
    const double side = w[i] > 0.0 ? half[i] : -half[i];
    out.push_back({(1.0 / w[i]) * (constant(side) - foot), {}, size / std::abs(w[i]), false});
  }
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      const Eigen::Vector2d center(x * (half.x() - box.corner), y * (half.y() - box.corner));
      const Eigen::Vector2d u(w.x() / c.across, w.y() / c.across);
      const auto along = c.along - constant(center.dot(u));
      const auto beside = c.beside - constant(center.x() * u.y() - center.y() * u.x());
      const auto radius = constant(box.corner);
      out.push_back({(-1.0 / c.across) * along,
                     (1.0 / (c.across * c.across)) * ((radius - beside) * (radius + beside)), size,
                     true});
    }
  return out;
}

/// Where an elbow begins or ends to be met.
std::vector<double> elbow_silhouettes(const PreparedElbow& elbow, double rho) {
  const auto pass = [&](double phi) { return elbow_pass(elbow, generator_at(rho, phi)); };
  const auto border = [&](double met, double missed) {
    return math::last_true([&](double t) { return pass(met + t * (missed - met)).met; }, 0.0, 1.0) *
               (missed - met) +
           met;
  };
  std::vector<ElbowPass> scan;
  for (int k = 0; k <= kScan + 1; ++k) scan.push_back(pass(kTwoPi * k / kScan));
  std::vector<double> out;
  for (std::size_t k = 0; k < kScan; ++k) {
    const double phi = kTwoPi * static_cast<double>(k) / kScan;
    const double next = phi + kTwoPi / kScan;
    if (scan[k].met != scan[k + 1].met)
      out.push_back(scan[k].met ? border(phi, next) : border(next, phi));
    // A generator between may dip in where the clearance has a least value.
    const bool least = !scan[k].met && !scan[k + 1].met && !scan[k + 2].met &&
                       scan[k + 1].clearance <= std::min(scan[k].clearance, scan[k + 2].clearance);
    if (!least) continue;
    const auto nearest = math::golden_maximum([&](double at) { return -pass(at).clearance; }, phi,
                                              next + kTwoPi / kScan);
    if (!pass(nearest.at).met) continue;
    out.push_back(border(nearest.at, phi));
    out.push_back(border(nearest.at, next + kTwoPi / kScan));
  }
  return out;
}

}  // namespace

std::vector<Sheets> sheets(const Prepared& cutter, double rho) {
  if (const auto* plane = std::get_if<PreparedPlane>(&cutter)) return {plane_sheets(*plane, rho)};
  if (const auto* box = std::get_if<PreparedBox>(&cutter)) return box_sheets(*box, rho);
  if (const auto* cone = std::get_if<PreparedCone>(&cutter)) return {cone_sheets(*cone, rho)};
  if (const auto* tube = std::get_if<PreparedTube>(&cutter)) return {tube_sheets(*tube, rho)};
  return {};
}

std::vector<double> silhouettes(const Prepared& cutter, double rho) {
  std::vector<double> out;
  if (const auto* box = std::get_if<PreparedBox>(&cutter)) {
    // The generator touches a corner: a straight line at distance `corner` from its centre.
    const auto& w = box->frame.rise;
    const auto c = crossing(box->frame, rho);
    const double support = (std::abs(w.y()) * (box->half_width - box->corner) +
                            std::abs(w.x()) * (box->half_height - box->corner)) /
                               c.across +
                           box->corner;
    for (const double side : {support, -support})
      for (const double phi : root_phases(c.beside - constant(side))) out.push_back(phi);
  } else if (std::holds_alternative<PreparedCone>(cutter)) {
    out = root_phases(sheets(cutter, rho).front().square);
  } else if (const auto* elbow = std::get_if<PreparedElbow>(&cutter)) {
    out = elbow_silhouettes(*elbow, rho);
  }
  return out;
}

}  // namespace tubecut::joint
