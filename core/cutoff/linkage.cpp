#include "core/cutoff/linkage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/cutoff/preconditions.hpp"
#include "core/math/search.hpp"

namespace tubecut::cutoff {
namespace {

using elementary::atan2;
using elementary::cos;
using elementary::sin;
using elementary::SinCos;
using elementary::sincos;

constexpr double kDeadPointMargin =
    1e-9;  // of 1 - rho cos e: below it, the slot counts as tangent to the arm circle
constexpr double kTangentMargin =
    1e-6;  // of cos^2(theta - beta): nearer than 0.06 deg the inverse loses its digits
constexpr double kStrokeMargin = 1e-12;  // fraction of the stroke's width, margin to both limits
constexpr int kPeakScan = 64;            // steps of psi that separate the roots of g''

double reduced(double angle) {  // Reduces an angle to (-pi, pi].
  return angle - kTwoPi * std::ceil((angle - kPi) / kTwoPi);
}

/// Computes sine and cosine of a - b.
SinCos difference(const SinCos& a, const SinCos& b) {
  return {a.sin * b.cos - a.cos * b.sin, a.cos * b.cos + a.sin * b.sin};
}

/// Computes sine and cosine of half an angle within (-pi, pi), by the root that does not cancel.
SinCos half_of(const SinCos& whole) {
  if (whole.cos >= 0.0) {
    const double cosine = std::sqrt(0.5 * (1.0 + whole.cos));
    return {0.5 * whole.sin / cosine, cosine};
  }
  const double sine = std::copysign(std::sqrt(0.5 * (1.0 - whole.cos)), whole.sin);
  return {sine, 0.5 * whole.sin / sine};
}

constexpr double kLeastPair = 1e-3;  // mm; a shorter feed is too inaccurate for a calibration
constexpr double kLeastRate = 1e-9, kMostRate = 10;  // rad/mm

Result<void> check(const Linkage& l) {
  Preconditions on("linkage/");
  on.positive("arm", l.arm, "mm");
  on.positive("pivot_distance", l.pivot_distance, "mm");
  on.positive("pivot_offset", l.pivot_offset, "mm");
  on.require(std::abs(l.rest_angle.rad()) < kPi, "rest_angle", l.rest_angle.deg(),
             "within (-180, 180)", "deg");
  on.require(l.slot_angle.rad() > 0.0 && l.slot_angle.rad() < kPi, "slot_angle", l.slot_angle.deg(),
             "within (0, 180)", "deg");
  if (!l.calibrate) on.positive("rad_per_mm", l.rad_per_mm, "rad_per_mm");
  if (l.calibrate) {
    const auto [feed, stroke] = *l.calibrate;
    on.require(std::abs(feed) >= kLeastPair, "calibrate/feed", feed, "at least 0.001 from 0", "mm");
    on.require(feed * stroke > 0.0, "calibrate/stroke", stroke, "not 0, of the feed's sign", "mm");
  }
  return on.met();
}

}  // namespace

Result<Mechanism> Mechanism::make(const Linkage& l) {
  TRY(check(l));
  if (l.calibrate && l.rad_per_mm != 0.0)
    return fail({.code = ErrorCode::exclusive_fields, .member = "linkage/calibrate"});
  if (l.pivot_distance < l.pivot_offset)
    return fail({.code = ErrorCode::r2_lt_a,
                 .member = "linkage/pivot_distance",
                 .got = l.pivot_distance,
                 .limit = l.pivot_offset,
                 .unit = "mm"});
  Mechanism m;
  TRY(m.set_rest(l));
  m.set_limits();
  TRY(m.set_rate(l));
  m.geometry_.feed_at_peak = m.find_peak();
  return m;
}

/// Computes the position at rest, from the triangle O1 O2 P in units of the arm.
Result<void> Mechanism::set_rest(const Linkage& l) {
  const auto wrong = [](ErrorCode code, const char* member, Angle got) {
    return fail({.code = code, .member = member, .got = got.deg(), .unit = "deg"});
  };
  offset_ = l.pivot_offset;
  ratio_ = l.pivot_distance / l.arm;
  one_minus_ratio_ = (l.arm - l.pivot_distance) / l.arm;
  const double height2 = (l.pivot_distance - l.pivot_offset) * (l.pivot_distance + l.pivot_offset);
  lag_ = atan2(std::sqrt(height2), l.pivot_offset) - l.rest_angle.rad();
  lag_half_ = sincos(0.5 * lag_);
  const double lead = lead_of(lag_half_);
  if (std::abs(lead) < kDeadPointMargin)
    return wrong(ErrorCode::dead_point, "linkage/rest_angle", l.rest_angle);
  if (lead < 0.0) return wrong(ErrorCode::reversed, "linkage/rest_angle", l.rest_angle);
  const double across = ratio_ * sin(lag_);
  const double reach = elementary::hypot(lead, across);  // |O2 P| / R1
  const double swing = atan2(across, lead);              // theta0 - beta0
  slot_lag_ = lag_ + swing;
  slot_lag_sides_ = sincos(slot_lag_);
  sine_ = across / reach;
  cosine_ = lead / reach;
  const double psi = reduced(kPi - l.slot_angle.rad() - (l.rest_angle.rad() - swing));
  if (std::abs(psi) >= 0.5 * kPi)
    return wrong(ErrorCode::slot_off_rod, "linkage/slot_angle", l.slot_angle);
  psi_ = sincos(psi);
  geometry_.slot_elevation = Angle::rad(psi);
  geometry_.rod_height = l.pivot_offset * elementary::tan(psi);
  return {};
}

/// Computes 1 - rho cos e from half of e, without cancellation near a dead point.
double Mechanism::lead_of(const SinCos& half) const {
  return one_minus_ratio_ + 2.0 * ratio_ * half.sin * half.sin;
}

/// Computes the angle of slot 1 from rest at a feed: tan(psi0 - psi) from the two tangents, so
/// nothing cancels near rest.
Mechanism::SlotTurn Mechanism::slot_turn(double feed) const {
  const double x0 = geometry_.rod_height;
  const double across = feed / offset_;
  const double along = 1.0 + (x0 / offset_) * ((x0 - feed) / offset_);
  const double per_reach = 1.0 / elementary::hypot(across, along);
  const SinCos whole{across * per_reach, along * per_reach};
  return {whole, half_of(whole)};
}

Mechanism::SlotTurn Mechanism::slot_turned(double angle) {
  return {sincos(angle), sincos(0.5 * angle)};
}

double Mechanism::arm_turn(const SlotTurn& slot) const {
  const double sine = ratio_ * difference(slot_lag_sides_, slot.whole).sin;
  const SinCos half = half_arm_turn(slot, std::sqrt(std::max(0.0, (1.0 - sine) * (1.0 + sine))));
  return 2.0 * atan2(half.sin, half.cos);
}

/// theta - theta0 = (beta - beta0) + asin(rho sin delta) - asin(rho sin delta0). The difference of
/// the two arcs is 2 atan of (difference of sines)/(sum of cosines), which keeps full relative
/// accuracy near rest. Half of either term is within a quarter turn, so one arctangent gives their
/// sum.
SinCos Mechanism::half_arm_turn(const SlotTurn& slot, double cosine) const {
  const SinCos& half = slot.half;
  const double rise = -2.0 * ratio_ * difference(slot_lag_sides_, half).cos * half.sin;
  const double run = cosine + cosine_;
  return {half.sin * run + half.cos * rise, half.cos * run - half.sin * rise};
}

Mechanism::Limit Mechanism::limit(double pole, double dead, bool upper) const {
  const bool dead_first = upper ? dead < pole : dead > pole;
  if (!dead_first) return {arm_turn(slot_turned(pole)), {}, false};
  const double psi = geometry_.slot_elevation.rad();
  // sin(theta - beta) is exactly 1 or -1 there; its cosine would lose half the digits
  const double turn = dead + (upper ? 0.5 * kPi : -0.5 * kPi) - atan2(sine_, cosine_);
  return {turn, offset_ * sin(dead) / (psi_.cos * cos(psi - dead)), true};
}

void Mechanism::set_limits() {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double psi = geometry_.slot_elevation.rad();
  double dead_low = -kNever;
  double dead_high = kNever;
  if (one_minus_ratio_ <= 0.0) {  // slot 1 is tangent to the arm circle at |sin delta| = 1/rho
    const double half_width = elementary::asin(1.0 / ratio_);
    const double centre = kPi + kTwoPi * std::floor(slot_lag_ / kTwoPi);
    dead_low = slot_lag_ - centre - half_width;
    dead_high = slot_lag_ - centre + half_width;
  }
  low_ = limit(psi - 0.5 * kPi, dead_low, false);
  high_ = limit(psi + 0.5 * kPi, dead_high, true);
  geometry_.feed_low = low_.feed;
  geometry_.feed_high = high_.feed;
}

Result<void> Mechanism::set_rate(const Linkage& l) {
  k_ = l.rad_per_mm;
  if (l.calibrate) {
    const auto [feed, stroke] = *l.calibrate;
    k_ = 1.0;
    if (!reaches(feed))
      return fail({.code = ErrorCode::unreachable_x,
                   .member = "linkage/calibrate/feed",
                   .got = feed,
                   .unit = "mm"});
    k_ = arm_turn(slot_turn(feed)) / stroke;
    if (!(k_ >= kLeastRate && k_ <= kMostRate))
      return fail({.code = ErrorCode::out_of_range,
                   .member = "linkage/calibrate",
                   .got = k_,
                   .limit = Intervals{{kLeastRate, kMostRate}},
                   .unit = "rad_per_mm",
                   .hint = "the arm's turn per stroke that this pair gives"});
  }
  geometry_.rad_per_mm = k_;
  geometry_.stroke_low = low_.turn / k_;
  geometry_.stroke_high = high_.turn / k_;
  return {};
}

bool Mechanism::reaches(double feed) const {
  if (!std::isfinite(feed) || (low_.feed && feed <= *low_.feed) ||
      (high_.feed && feed >= *high_.feed))
    return false;
  const double margin = kStrokeMargin * (high_.turn - low_.turn);
  const SlotTurn slot = slot_turn(feed);
  const double sine = ratio_ * difference(slot_lag_sides_, slot.whole).sin;
  if (!((1.0 - sine) * (1.0 + sine) > kTangentMargin)) return false;
  const double turn = arm_turn(slot);
  return turn > low_.turn + margin && turn < high_.turn - margin;
}

Result<double> Mechanism::tool_feed(double stroke) const {
  const double turn = k_ * stroke;
  const double margin = kStrokeMargin * (high_.turn - low_.turn);
  if (turn > low_.turn + margin && turn < high_.turn - margin) return forward(stroke).feed;
  if (!std::isfinite(stroke))
    return fail({.code = ErrorCode::not_finite, .member = "stroke", .unit = "mm"});
  const Limit& crossed = turn < 0.0 ? low_ : high_;
  return fail({.code = crossed.dead_point ? ErrorCode::dead_point : ErrorCode::tan_pole,
               .member = "stroke",
               .got = stroke,
               .limit = Intervals{{geometry_.stroke_low, geometry_.stroke_high}},
               .unit = "mm"});
}

/// With sine and cosine of half the arm's turn, the rest is algebra: e = e0 - turn, beta's turn
/// less the arm's as a quotient, sums of angles by their sines and cosines.
Forward Mechanism::forward(double stroke) const {
  const SinCos half = sincos(0.5 * k_ * stroke);
  const SinCos turn{2.0 * half.sin * half.cos, (half.cos - half.sin) * (half.cos + half.sin)};
  const SinCos lag_half = difference(lag_half_, half);
  const double lead = lead_of(lag_half), lead_rest = lead_of(lag_half_);
  const double across = 2.0 * ratio_ * lag_half.sin * lag_half.cos;
  const double across_rest = 2.0 * ratio_ * lag_half_.sin * lag_half_.cos;
  // e0 - turn / 2 = e0 / 2 + e / 2
  const double middle = lag_half_.cos * lag_half.cos - lag_half_.sin * lag_half.sin;
  const double cross = 2.0 * ratio_ * half.sin * (ratio_ * half.cos - middle);
  const double dot = lead * lead_rest + across * across_rest;
  const double size = elementary::hypot(cross, dot);
  const SinCos slot = difference(turn, {cross / size, dot / size});
  const double cos_psi = difference(psi_, slot).cos;
  const double reach2 =
      one_minus_ratio_ * one_minus_ratio_ + 4.0 * ratio_ * lag_half.sin * lag_half.sin;
  return {offset_ * slot.sin / (psi_.cos * cos_psi),
          k_ * offset_ * lead / (cos_psi * cos_psi * reach2)};
}

Inverse Mechanism::inverse(double feed) const {
  SinCos half;
  Inverse out = inverse(feed, half);
  out.stroke = 2.0 * atan2(half.sin, half.cos) / k_;
  return out;
}

Inverse Mechanism::inverse(double feed, SinCos& half) const {
  const double a = offset_;
  const double q = geometry_.rod_height - feed;
  const SlotTurn slot = slot_turn(feed);
  const SinCos delta = difference(slot_lag_sides_, slot.whole);
  const double rho = ratio_;
  const double u = rho * delta.sin, along = rho * delta.cos;
  const double w = std::sqrt((1.0 - u) * (1.0 + u)), per_w = 1.0 / w;
  const double spread = one_minus_ratio_ * (1.0 + rho);  // 1 - rho^2
  const double b = a / (a * a + q * q), per_k = 1.0 / k_, per_a = 1.0 / a;
  const double t = along > 0.0 ? spread * per_w / (w + along) : 1.0 - along * per_w;
  const double bend = spread * per_w * per_w * per_w;
  const double e = 2.0 * q * t * per_a - bend * u;
  const double e1 = -2.0 * t * per_a - 2.0 * q * b * per_a * bend * u +
                    b * bend * along * (1.0 + 3.0 * u * u * per_w * per_w);
  half = half_arm_turn(slot, w);
  return {0.0, b * t * per_k, b * b * e * per_k, b * b * (4.0 * q * b * e * per_a + e1) * per_k};
}

/// Computes atan of a small tangent by its series, truncated below 1e-22 relative.
Inverse StrokeCursor::at(double feed) {
  constexpr double kNear = 1e-3;
  SinCos half;
  Inverse out = mechanism_->inverse(feed, half);
  const double cross = half.sin * anchor_.cos - half.cos * anchor_.sin;
  const double dot = half.cos * anchor_.cos + half.sin * anchor_.sin;
  double turned = cross / dot;
  if (dot > 0.0 && std::abs(turned) < kNear) {
    const double square = turned * turned;
    turned *= 1.0 - square * (1.0 / 3.0 - square * (1.0 / 5.0));
  } else {
    anchor_ = half;
    angle_ = atan2(half.sin, half.cos);
    turned = 0.0;
  }
  out.stroke = 2.0 * (angle_ + turned) / mechanism_->k_;
  return out;
}

/// Finds the highest g' inside the range: a scan over psi brackets every root of g'' that matters,
/// bisection refines it.
std::optional<double> Mechanism::find_peak() const {
  const double psi = geometry_.slot_elevation.rad();
  const auto angle = [this](double feed) {
    const SinCos turn = slot_turn(feed).whole;
    return atan2(turn.sin, turn.cos);
  };
  const double turn_low = low_.feed ? angle(*low_.feed) : psi - 0.5 * kPi;
  const double turn_high = high_.feed ? angle(*high_.feed) : psi + 0.5 * kPi;
  const auto feed_at = [&](int i) {
    const double turn = turn_low + (turn_high - turn_low) * (i + 0.5) / kPeakScan;
    return offset_ * sin(turn) / (psi_.cos * cos(psi - turn));
  };
  std::optional<double> peak;
  double left = feed_at(0);
  bool rising = inverse(left).second > 0.0;
  for (int i = 1; i < kPeakScan; ++i) {
    const double right = feed_at(i);
    const bool rises_on = inverse(right).second > 0.0;
    if (rising && !rises_on) {
      const double at =
          math::sign_change([this](double x) { return inverse(x).second; }, left, right);
      if (!peak || inverse(at).first > inverse(*peak).first) peak = at;
    }
    left = right;
    rising = rises_on;
  }
  return peak;
}

}  // namespace tubecut::cutoff
