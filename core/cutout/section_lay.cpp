#include "core/cutout/section_lay.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::cutout {
namespace {

using Eigen::Vector2d;
using section::Station;

constexpr double kQuarter = 0.5 * kPi;
constexpr double kEdgeOn = 1e-12;     // of a direction: a flat seen along itself
constexpr double kOffBreak = 1e-9;    // mm, from a break
constexpr double kFound = 1e-13;      // of a way that is halved
constexpr double kLeastShare = 1e-9;  // of a segment

double cross2(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Of the area that the line from the axis to the outline sweeps from the datum line to `s`.
double swept_to(const section::Curve& curve, double s) {
  const double girth = curve.girth(), turns = std::floor(s / girth);
  double whole = 0.0, part = 0.0;
  for (const auto& segment : curve.segments()) {
    const auto over = [&](double begin, double from, double to) {
      if (!(to > from)) return 0.0;
      if (!segment.is_arc()) return 0.5 * segment.normal.dot(segment.origin) * (to - from);
      const auto tangent = [&](double at) {
        const auto turn = elementary::sincos(segment.nu + (at - begin) / segment.radius);
        return Vector2d(-turn.sin, turn.cos);
      };
      return 0.5 * (segment.radius * (to - from) -
                    segment.radius * segment.origin.dot(tangent(to) - tangent(from)));
    };
    whole += over(segment.from, segment.from, segment.to());
    // The first segment may begin before the datum, and ends the turn too.
    const double end = s - turns * girth, last = segment.from + girth;
    part += over(segment.from, std::max(0.0, segment.from), std::min(segment.to(), end));
    part += over(last, last, std::min(girth, end));
  }
  return turns * whole + part;
}

double whole_turns(double s, double girth, double other, double other_girth) {
  return std::round(s / girth - other / other_girth);
}

}  // namespace

Sight::Sight(const section::Curve& curve, const Station& from)
    : normal_(from.normal), tangent_(from.tangent()), nu_(from.nu) {
  for (const auto& segment : curve.segments())
    for (int turn = -1; turn <= 1; ++turn) add(curve, segment, turn);
  std::ranges::sort(pieces_, {}, &Piece::y);
  for (const auto& piece : pieces_) breaks_.push_back(piece.y);
  double most = breaks_.front();
  for (const auto& segment : curve.segments()) {
    if (segment.is_arc())
      most = std::max(most, segment.origin.dot(tangent_) + segment.radius);
    else
      most = std::max(
          {most, segment.origin.dot(tangent_),
           (segment.origin + segment.length * Vector2d(-segment.normal.y(), segment.normal.x()))
               .dot(tangent_)});
  }
  breaks_.push_back(most);
}

void Sight::add(const section::Curve& curve, const section::OutlineSegment& segment, int turn) {
  const double nu = segment.nu + turn * kTwoPi, s = segment.from + turn * curve.girth();
  if (!segment.is_arc()) {
    const double share = segment.normal.dot(normal_);
    if (!(std::abs(nu - nu_) < kPi) || !(share > kEdgeOn)) return;
    pieces_.push_back({.y = segment.origin.dot(tangent_), .s = s, .nu = nu, .share = share});
    return;
  }
  const double from = std::max(nu, nu_ - kQuarter);
  const double to = std::min(nu + segment.length / segment.radius, nu_ + kQuarter);
  if (!(to - from > kEdgeOn)) return;
  const double centre = segment.origin.dot(tangent_);
  pieces_.push_back({.y = centre + segment.radius * elementary::sin(from - nu_),
                     .s = s + segment.radius * (from - nu),
                     .nu = from,
                     .radius = segment.radius,
                     .centre = centre});
}

double Sight::s(double y) const {
  auto at = std::ranges::upper_bound(pieces_, y, {}, &Piece::y);
  if (at != pieces_.begin()) --at;
  if (at->radius == 0.0) return at->s + (y - at->y) / at->share;
  const double turned = elementary::asin(std::clamp((y - at->centre) / at->radius, -1.0, 1.0));
  return at->s + at->radius * (nu_ + turned - at->nu);
}

bool Sight::sees(const Station& at) const { return at.normal.dot(normal_) > kEdgeOn; }

namespace {

/// The place that the near or the far side is seen from.
Station seen_from(const section::Curve& curve, double s, bool far) {
  Station out = curve.at(s);
  if (!far) return out;
  out.normal = -out.normal;
  out.point = -out.point;
  out.nu = out.nu < kPi ? out.nu + kPi : out.nu - kPi;
  return out;
}

}  // namespace

SectionLay::SectionLay(const section::Wall& wall, double s, Lay lay, bool far)
    : wall_(wall),
      s_(s),
      lay_(lay),
      far_(far),
      from_(seen_from(wall.outer(), s, far)),
      outer_(wall.outer(), from_),
      bore_(wall.bore(), from_),
      y_(wall.outer().at(s).point.dot(wall.outer().at(s).tangent())),
      anchor_(at(0.0)) {
  find_breaks();
}

double SectionLay::bore_of(double s) const {
  const double at = wall_.across(wall_.outer().at(s)).bore.s, girth = wall_.bore().girth();
  return at + whole_turns(s, wall_.outer().girth(), at, girth) * girth;
}

double SectionLay::outside_of(double s_bore) const {
  const double at = wall_.outside_of(wall_.bore().at(s_bore)), girth = wall_.outer().girth();
  return at + whole_turns(s_bore, wall_.bore().girth(), at, girth) * girth;
}

EdgePlace SectionLay::at(double b) const {
  EdgePlace out;
  if (lay_ == Lay::developed) {
    out.s = s_ + sense() * b;
    out.s_bore = bore_of(out.s);
  } else {
    out.s_bore = bore_.s(y(b));
    out.s = lay_ == Lay::prism ? outer_.s(y(b)) : outside_of(out.s_bore);
  }
  out.outer = wall_.outer().at(out.s);
  out.bore = wall_.bore().at(out.s_bore);
  return out;
}

double SectionLay::way(double b, bool outer) const {
  const auto here = at(b);
  return sense() * (outer ? here.s - anchor_.s : here.s_bore - anchor_.s_bore);
}

double SectionLay::way_on_bore(double way) const {
  return sense() * (bore_of(anchor_.s + sense() * way) - anchor_.s_bore);
}

double SectionLay::lean(double b) const {
  return std::remainder(at(b).outer.nu - from_.nu, kTwoPi);
}

SectionLay::Rates SectionLay::rates(double b) const {
  const auto here = at(b);
  const auto& n = here.outer.normal;
  const double slope = here.bore.normal.dot(here.outer.tangent()) / here.bore.normal.dot(n);
  const double thick = (here.outer.point - here.bore.point).norm();
  const double shrinks = 1.0 - here.outer.curvature * thick;
  // Of the bore's way to the outside's, where the wall is square to the outside.
  const double square = shrinks * elementary::hypot(1.0, slope);
  if (lay_ == Lay::developed) return {1.0, square};
  const double bore = 1.0 / here.bore.normal.dot(from_.normal);
  if (lay_ == Lay::bored) return {bore / square, bore};
  return {1.0 / n.dot(from_.normal), bore};
}

double SectionLay::area(double b) const {
  const auto here = at(b);
  return swept_to(wall_.outer(), here.s) - swept_to(wall_.bore(), here.s_bore) +
         0.5 * cross2(here.outer.point, here.bore.point);
}

double SectionLay::depth(double b) const {
  const auto here = at(b);
  const auto rate = rates(b);
  const Vector2d along =
      0.5 * (rate.outer * here.outer.tangent() + rate.bore * here.bore.tangent());
  return std::abs(cross2(along, here.outer.point - here.bore.point));
}

void SectionLay::find_breaks() {
  const auto& outer = wall_.outer();
  const auto& bore = wall_.bore();
  auto bore_seams = bore.seams();
  if (bore.corner() == 0.0)
    for (int corner = 1; corner <= 4; ++corner)
      bore_seams.push_back(bore.on_face(corner, bore.half_flat(corner)));
  if (lay_ != Lay::developed) {
    const auto keep = [&](double y) { breaks_.push_back(far_ ? -y - y_ : y - y_); };
    for (const double y : bore_.breaks()) keep(y);
    if (lay_ == Lay::prism)
      for (const double y : outer_.breaks()) keep(y);
    if (lay_ == Lay::bored)
      for (const double s : outer.seams()) {
        const auto foot = wall_.across(outer.at(s)).bore;
        if (bore_.sees(foot)) keep(bore_.y_of(foot.point));
      }
  } else {
    auto seams = outer.seams();
    for (const double s : bore_seams) seams.push_back(wall_.outside_of(bore.at(s)));
    for (const double s : seams)
      for (int turn = -2; turn <= 2; ++turn)
        breaks_.push_back(sense() * (s + turn * outer.girth() - s_));
  }
  std::ranges::sort(breaks_);
}

Bounds SectionLay::reach() const {
  const double least = bore_.breaks().front(), most = bore_.breaks().back();
  return far_ ? Bounds{{0.0, -most - y_}, {0.0, -least - y_}}
              : Bounds{{0.0, least - y_}, {0.0, most - y_}};
}

double SectionLay::most_kerf() const {
  return 2.0 * (wall_.outer().corner() - wall_.section().wall);
}

namespace {

/// The wall's edge at one place of the outside, as beams next to it see it.
class WallEdge {
 public:
  WallEdge(const section::Wall& wall, double s, double side) : wall_(wall), s_(s), side_(side) {
    const auto at = wall.outer().at(s);
    const auto across = wall.across(at);
    foot_ = across.bore.point;
    const double slope = across.bore.normal.dot(at.tangent()) / across.bore.normal.dot(at.normal);
    way_ = (1.0 - at.curvature * across.wall) * (at.tangent() - slope * at.normal);
  }

  struct Seen {
    double off, rate;  // from the axis, mm, and how much this grows as the edge moves on
  };
  /// By a beam whose axis lies a way before it.
  [[nodiscard]] Seen from(double way) const {
    const auto axis = wall_.outer().at(s_ - side_ * way);
    return {side_ * (foot_ - axis.point).dot(axis.tangent()), way_.dot(axis.tangent())};
  }
  /// How far before it the axis lies from which it is seen at `off`.
  [[nodiscard]] double way_at(double off) const {
    double high = off;
    const double most = 0.5 * wall_.outer().girth();
    while (from(high).off < off && high < most) high *= 1.25;
    return halved(0.0, high, [&](double way) { return from(way).off < off; });
  }
  template <class F>
  static double halved(double low, double high, const F& below) {
    const double close = kFound * high;
    while (high - low > close) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (below(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  const section::Wall& wall_;
  double s_, side_;
  Vector2d foot_, way_;
};

}  // namespace

Flat SectionLay::contact(double edge, const Flat& m, double kerf) const {
  if (m.x() == 0.0 || m.y() == 0.0) return m;
  const double half = 0.5 * kerf;
  const WallEdge wall(wall_, anchor_.s + sense() * edge, sense() * std::copysign(1.0, m.y()));
  const auto along = [&](double off) {
    return std::sqrt(std::max(0.0, (half - off) * (half + off)));
  };
  const double way = WallEdge::halved(0.0, wall.way_at(half), [&](double at) {
    const auto seen = wall.from(at);
    return along(seen.off) * std::abs(m.y()) > seen.off * seen.rate * std::abs(m.x());
  });
  const double off = std::min(half, wall.from(way).off);
  return {std::copysign(along(off) / half, m.x()), std::copysign(off / half, m.y())};
}

double SectionLay::axis(double edge, double side) const {
  if (side == 0.0) return edge;
  const WallEdge wall(wall_, anchor_.s + sense() * edge, sense() * std::copysign(1.0, side));
  return edge - std::copysign(wall.way_at(std::abs(side)), side);
}

namespace {

/// The shares of a segment where it crosses the line b.
std::vector<double> crossings(const Segment& s, double b) {
  if (!s.arc()) {
    const double rise = s.to.y() - s.from.y();
    return rise == 0.0 ? std::vector<double>{} : std::vector<double>{(b - s.from.y()) / rise};
  }
  const double sine = (b - s.centre.y()) / s.radius;
  if (!(std::abs(sine) < 1.0)) return {};
  const double first = elementary::asin(sine);
  std::vector<double> out;
  for (const double angle : {first, kPi - first})
    for (int turn = -2; turn <= 2; ++turn)
      out.push_back((angle + turn * kTwoPi - s.angle) / s.sweep);
  return out;
}

Segment part_of(const Segment& s, double from, double to) {
  Segment out = s;
  out.from = from == 0.0 ? s.from : s.at(from);
  out.to = to == 1.0 ? s.to : s.at(to);
  if (s.arc()) {
    out.angle = s.angle + from * s.sweep;
    out.sweep = (to - from) * s.sweep;
  }
  return out;
}

}  // namespace

Chain divided(const Chain& chain, const std::vector<double>& breaks) {
  Chain out;
  for (const auto& s : chain) {
    std::vector<double> shares{0.0};
    std::vector<double> found;
    for (const double b : breaks)
      for (const double share : crossings(s, b))
        if (share > kLeastShare && share < 1.0 - kLeastShare) found.push_back(share);
    std::ranges::sort(found);
    for (const double share : found)
      if (share - shares.back() > kLeastShare) shares.push_back(share);
    shares.push_back(1.0);
    for (std::size_t i = 0; i + 1 < shares.size(); ++i)
      out.push_back(part_of(s, shares[i], shares[i + 1]));
  }
  return out;
}

double inside(const Segment& s, double b) {
  const auto box = bounds({s});
  const double low = box.least.y() + kOffBreak, high = box.most.y() - kOffBreak;
  return low < high ? std::clamp(b, low, high) : b;
}

namespace {

/// The shares within an arc where it turns back across: next to them b may come near to a break
/// that no segment crosses.
std::vector<double> turns_back(const Segment& s) {
  std::vector<double> out;
  if (!s.arc()) return out;
  for (int half = -4; half <= 4; ++half)
    if (const double share = (kQuarter + half * kPi - s.angle) / s.sweep;
        share > kLeastShare && share < 1.0 - kLeastShare)
      out.push_back(share);
  return out;
}

/// Cells of a segment's part, finer towards its ends.
void add_cells(const Segment& s, double from, double to, std::vector<double>& out) {
  constexpr int kMiddle = 4, kFiner = 8;
  constexpr double kPlacesATurn = 40.0, kRatio = 0.3;
  const double places = kPlacesATurn * std::abs(s.sweep) * (to - from) / kTwoPi;
  const int count = s.arc() ? std::max(kMiddle, static_cast<int>(std::ceil(places))) : kMiddle;
  const double cell = (to - from) / count;
  out.push_back(from);
  for (int i = 1; i < count; ++i) out.push_back(from + i * cell);
  double way = cell;
  for (int i = 0; i < kFiner; ++i) {
    way *= kRatio;
    out.push_back(from + way);
    out.push_back(to - way);
  }
}

}  // namespace

std::vector<double> cells(const Segment& s) {
  std::vector<double> ends = turns_back(s), out;
  ends.push_back(1.0);
  std::ranges::sort(ends);
  double from = 0.0;
  for (const double to : ends) {
    add_cells(s, from, to, out);
    from = to;
  }
  out.push_back(1.0);
  std::ranges::sort(out);
  return out;
}

}  // namespace tubecut::cutout
