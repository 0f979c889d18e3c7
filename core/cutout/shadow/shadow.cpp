#include "core/cutout/shadow/shadow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/rounding.hpp"
#include "core/base/try.hpp"
#include "core/cutout/biarc.hpp"
#include "core/cutout/shadow/profile.hpp"

namespace tubecut::cutout {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTouch = 1e-9;      // mm, by which a line may miss the outline and still touch it
constexpr double kBeyond = 1e-10;    // mm, that another contact must reach further
constexpr double kAside = 1e-9;      // mm, from a seam
constexpr double kNarrow = 1e-6;     // mm of s that make no piece
constexpr double kApart = 1.5e-6;    // mm, between places that need a line
constexpr int kPlaces = 24;          // of each stretch of s, for changes of the contact
constexpr double kBesideEnd = 1e-7;  // of a stretch
constexpr int kHalvings = 14;        // of a piece
constexpr double kLevel = 1e-12;     // mm: a line that runs along z in the branch's plane

/// The wall's line as the prism sees it, (c, w): c across the axis and z, w along z.
struct Seen {
  Vector2d outer, bore, outer_rate, bore_rate;
};

/// The part of the outline that touches a line, and its place on the line.
struct Contact {
  enum class Kind { outer, bore, between, corner };
  Kind kind = Kind::outer;
  std::size_t span = 0;
  [[nodiscard]] bool operator==(const Contact&) const = default;
};
struct Touch {
  double height = 0.0, depth = 0.0;  // of w; from 0 outside to 1 on the bore
};

/// The prism and the tube in the frame of their crossing.
class Crossing {
 public:
  Crossing(const Prism& prism, const SquareLines& lines) : prism_(prism), lines_(lines) {
    const Vector2d flat = prism.axis.head<2>().normalized();
    towards_ = flat;
    across_ = Vector2d(-flat.y(), flat.x());
    const Vector3d along = Vector3d::UnitZ() - prism.axis.z() * prism.axis;
    steep_ = along.norm();
    along_ = along / steep_;
  }

  [[nodiscard]] Profile profile(double sense) const {
    const Vector3d c(across_.x(), across_.y(), 0.0);
    return {prism_.outline,
            {prism_.x.dot(c), prism_.y.dot(c)},
            {prism_.x.dot(along_), prism_.y.dot(along_)},
            sense};
  }
  /// A line of the wall; w counts in `sense`.
  [[nodiscard]] Seen seen(double s, double sense) const {
    const auto line = lines_.at(s);
    const auto turned = [&](const Vector2d& v) {
      return Vector2d(v.dot(across_), sense * v.dot(along_.head<2>()));
    };
    const Vector2d from = prism_.point.head<2>();
    Seen out{turned(line.outer - from), turned(line.bore - from), turned(line.outer_rate),
             turned(line.bore_rate)};
    if (prism_.outside_only) {
      out.bore = out.outer;
      out.bore_rate = out.outer_rate;
    }
    return out;
  }
  /// Of a height w of a touch to z.
  [[nodiscard]] double steep() const { return steep_; }
  [[nodiscard]] double z() const { return prism_.point.z(); }
  [[nodiscard]] const SquareLines& lines() const { return lines_; }
  [[nodiscard]] SquareLines::Side side() const { return lines_.side(towards_); }
  /// Where the axis leaves the outside.
  [[nodiscard]] double z_on_axis(double s) const {
    const Vector2d way = lines_.at(s).outer - prism_.point.head<2>();
    return z() + way.dot(towards_) / prism_.axis.head<2>().norm() * prism_.axis.z();
  }

 private:
  const Prism& prism_;
  const SquareLines& lines_;
  Vector2d towards_, across_;
  Vector3d along_;
  double steep_ = 1.0;
};

template <class F>
double halved(double low, double high, const F& below) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (!(middle > std::min(low, high)) || !(middle < std::max(low, high))) break;
    (below(middle) ? low : high) = middle;
  }
  return high;
}

/// One edge of the shadow: the greatest z of each s, or the least one.
class Edge {
 public:
  Edge(const Crossing& crossing, double sense)
      : crossing_(crossing), profile_(crossing.profile(sense)), sense_(sense) {}

  [[nodiscard]] const Profile& profile() const { return profile_; }
  [[nodiscard]] double sense() const { return sense_; }
  [[nodiscard]] Seen seen(double s) const { return crossing_.seen(s, sense_); }

  [[nodiscard]] Touch touch(const Contact& contact, const Seen& line) const {
    switch (contact.kind) {
      case Contact::Kind::outer:
        return {profile_.height(contact.span, line.outer.x()) - line.outer.y(), 0.0};
      case Contact::Kind::bore:
        return {profile_.height(contact.span, line.bore.x()) - line.bore.y(), 1.0};
      case Contact::Kind::between:
      case Contact::Kind::corner:
        break;
    }
    const Vector2d way = line.bore - line.outer;
    const auto& span = profile_.spans()[contact.span];
    const Vector2d place = contact.kind == Contact::Kind::corner
                               ? span.end
                               : Vector2d(span.centre + span.radius * square_to(way));
    const double depth = (place.x() - line.outer.x()) / way.x();
    return {place.y() - line.outer.y() - depth * way.y(), depth};
  }

  /// The contact that holds the edge; the line meets the outline.
  [[nodiscard]] Contact contact(double s) const {
    const auto line = seen(s);
    Contact best;
    double most = -std::numeric_limits<double>::infinity();
    const auto offer = [&](const Contact& one) {
      const auto here = touch(one, line);
      if (!(here.depth >= 0.0 && here.depth <= 1.0) || !(here.height > most + kBeyond)) return;
      best = one;
      most = here.height;
    };
    for (const bool outer : {true, false}) {
      const double c = outer ? line.outer.x() : line.bore.x();
      if (c < profile_.least() - kTouch || c > profile_.most() + kTouch) continue;
      offer({outer ? Contact::Kind::outer : Contact::Kind::bore, profile_.span_at(c)});
    }
    const Vector2d way = line.bore - line.outer;
    if (!(std::abs(way.x()) > kLevel)) return best;
    const Vector2d normal = square_to(way);
    for (std::size_t i = 0; i < profile_.spans().size(); ++i) {
      const auto& span = profile_.spans()[i];
      const double c = span.centre.x() + span.radius * normal.x();
      if (span.radius > 0.0 && c >= span.from && c <= span.to) offer({Contact::Kind::between, i});
      if (i + 1 < profile_.spans().size()) offer({Contact::Kind::corner, i});
    }
    return best;
  }

  /// A place of the edge, (z, s), and its direction as s grows.
  [[nodiscard]] Flat at(const Contact& contact, double s) const {
    return {crossing_.z() + sense_ * touch(contact, seen(s)).height / crossing_.steep(), s};
  }
  [[nodiscard]] Flat along(const Contact& contact, double s) const {
    const auto line = seen(s);
    const double depth = touch(contact, line).depth;
    const Vector2d normal =
        contact.kind == Contact::Kind::outer  ? profile_.normal(contact.span, line.outer.x())
        : contact.kind == Contact::Kind::bore ? profile_.normal(contact.span, line.bore.x())
                                              : square_to(line.bore - line.outer);
    const Vector2d rate = (1.0 - depth) * line.outer_rate + depth * line.bore_rate;
    return Flat(-sense_ * normal.dot(rate) / crossing_.steep(), normal.y()).normalized();
  }

 private:
  /// The unit normal of the wall's line that points out of this side of the outline.
  static Vector2d square_to(const Vector2d& way) {
    return std::copysign(1.0, way.x()) * Vector2d(-way.y(), way.x()).normalized();
  }

  const Crossing& crossing_;
  Profile profile_;
  double sense_;
};

/// The interval of s over which the prism meets the wall's lines; its places are counted by an
/// angle, in which an edge that turns round at an end stays smooth.
struct Reach {
  double from, to;

  [[nodiscard]] double s(double angle) const {
    return from + 0.5 * (to - from) * (1.0 - elementary::cos(angle));
  }
  [[nodiscard]] double angle(double s) const {
    return elementary::acos(std::clamp(1.0 - 2.0 * (s - from) / (to - from), -1.0, 1.0));
  }
};

/// A piece of an edge with one contact, between two seams; `from` and `to` are angles.
struct EdgePiece {
  const Edge* edge;
  const Reach* reach;
  Contact contact;
  double from, to;
  double least, most;  // of s where its direction is that of the piece, not beyond a seam

  [[nodiscard]] double s(double share) const { return reach->s(from + share * (to - from)); }
  [[nodiscard]] Flat at(double share) const { return edge->at(contact, s(share)); }
  [[nodiscard]] Flat along(double share) const {
    return (to > from ? 1.0 : -1.0) * edge->along(contact, std::clamp(s(share), least, most));
  }
  [[nodiscard]] EdgePiece first() const { return part(from, 0.5 * (from + to)); }
  [[nodiscard]] EdgePiece second() const { return part(0.5 * (from + to), to); }
  [[nodiscard]] EdgePiece part(double begin, double end) const {
    return {edge, reach, contact, begin, end, least, most};
  }
};

/// Where the ends of the lines pass the joints of the outline's spans, and seams.
std::vector<double> breaks_of(const Edge& edge, const Reach& reach, const SquareLines& lines) {
  auto out = lines.seams(reach.from, reach.to);
  out.push_back(reach.from);
  out.push_back(reach.to);
  const auto& spans = edge.profile().spans();
  for (std::size_t i = 0; i + 1 < spans.size(); ++i)
    for (const bool outer : {true, false})
      out.push_back(halved(reach.from, reach.to, [&](double s) {
        const auto line = edge.seen(s);
        return (outer ? line.outer : line.bore).x() < spans[i].to;
      }));
  std::ranges::sort(out);
  return out;
}

/// Divides an interval of angles where the contact changes.
void divide(const Edge& edge, const Reach& reach, double from, const Contact& first, double to,
            const Contact& last, std::vector<std::pair<double, Contact>>& out) {
  constexpr double kClose = 1e-12;  // rad
  if (first == last) return;
  const double middle = 0.5 * (from + to);
  if (to - from < kClose) {
    out.emplace_back(middle, last);
    return;
  }
  const auto there = edge.contact(reach.s(middle));
  divide(edge, reach, from, first, middle, there, out);
  divide(edge, reach, middle, there, to, last, out);
}

std::vector<EdgePiece> pieces_of(const Edge& edge, const Reach& reach, const SquareLines& lines) {
  std::vector<EdgePiece> out;
  const auto breaks = breaks_of(edge, reach, lines);
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    if (breaks[k + 1] - breaks[k] < kNarrow) continue;
    const double from = reach.angle(breaks[k]), to = reach.angle(breaks[k + 1]);
    const auto place = [&](int i) {
      const double share = static_cast<double>(i) / kPlaces;
      return from + std::clamp(share, kBesideEnd, 1.0 - kBesideEnd) * (to - from);
    };
    // At its ends an edge may turn round, so it keeps them.
    const double least = k == 0 ? breaks[k] : breaks[k] + kAside;
    const double most = k + 2 == breaks.size() ? breaks[k + 1] : breaks[k + 1] - kAside;
    std::vector<std::pair<double, Contact>> parts{{from, edge.contact(reach.s(place(0)))}};
    for (int i = 0; i < kPlaces; ++i)
      divide(edge, reach, place(i), edge.contact(reach.s(place(i))), place(i + 1),
             edge.contact(reach.s(place(i + 1))), parts);
    for (std::size_t i = 0; i < parts.size(); ++i)
      out.push_back({&edge, &reach, parts[i].second, parts[i].first,
                     i + 1 < parts.size() ? parts[i + 1].first : to, least, most});
  }
  return out;
}

/// Draws the edges one after the other, about the anchor.
class Outline {
 public:
  explicit Outline(const Flat& anchor) : anchor_(anchor) {}

  /// `turned`: from its end to where it begins.
  void add(std::vector<EdgePiece> pieces, bool turned) {
    if (turned) {
      std::ranges::reverse(pieces);
      for (auto& piece : pieces) std::swap(piece.from, piece.to);
    }
    for (const auto& piece : pieces) {
      const Flat begin = piece.at(0.0);
      if (!begun_) contour_.start = here_ = begin;
      begun_ = true;
      line_to(begin);
      std::vector<DrawnSegment> drawn;
      add_biarcs(piece, here_, kShadowOff, kHalvings, drawn);
      if (!drawn.empty()) here_ = drawn.back().to;
      contour_.pieces.insert(contour_.pieces.end(), drawn.begin(), drawn.end());
    }
  }

  [[nodiscard]] Contour take() {
    line_to(contour_.start);
    contour_.pieces.back().to = contour_.start;
    contour_.mirrored = true;
    contour_.start -= anchor_;
    for (auto& piece : contour_.pieces) {
      piece.to -= anchor_;
      if (piece.centre) *piece.centre -= anchor_;
    }
    return std::move(contour_);
  }

 private:
  void line_to(const Flat& p) {
    if (!((p - here_).norm() > kApart)) return;
    contour_.pieces.push_back({.to = p});
    here_ = p;
  }

  Flat anchor_, here_ = Flat::Zero();
  Contour contour_;
  bool begun_ = false;
};

tl::unexpected<Error> axis_misses() {
  return fail({.code = ErrorCode::open_profile,
               .member = "axis",
               .hint = "the branch's axis misses the tube"});
}

/// How far the shadow reaches round the tube from s on; to both ends of the side.
Result<Reach> reach_of(const Edge& edge, const SquareLines::Side& side, double s) {
  const double least = edge.profile().least(), most = edge.profile().most();
  const auto meets = [&](double at) {
    const auto line = edge.seen(at);
    return std::min(line.outer.x(), line.bore.x()) <= most &&
           std::max(line.outer.x(), line.bore.x()) >= least;
  };
  for (const double end : {side.from, side.to}) {
    if (!meets(end)) continue;
    const auto line = edge.seen(end);
    const double room = std::min(std::abs(line.outer.x()), std::abs(line.bore.x()));
    return fail({.code = ErrorCode::open_profile,
                 .got = end == side.to ? most : -least,
                 .limit = rounded_down(room),
                 .unit = "mm",
                 .hint = "to one side of its axis the branch reaches the side of the tube, along "
                         "which its hole would not end; make it less wide, or move its axis"});
  }
  return Reach{halved(s, side.from, meets), halved(s, side.to, meets)};
}

}  // namespace

Result<Shadow> shadow_of(const Prism& prism, const SquareLines& lines) {
  const Crossing crossing(prism, lines);
  const Edge upper(crossing, 1.0), lower(crossing, -1.0);
  const auto side = crossing.side();
  const auto before = [&](double s) { return upper.seen(s).outer.x() < 0.0; };
  if (!before(side.from) || before(side.to)) return axis_misses();
  Shadow out{.s = halved(side.from, side.to, before)};
  out.z = crossing.z_on_axis(out.s);
  TRY(const auto reach, reach_of(upper, side, out.s));
  Outline outline({out.z, out.s});
  outline.add(pieces_of(upper, reach, lines), false);
  outline.add(pieces_of(lower, reach, lines), true);
  out.contour = outline.take();
  return out;
}

}  // namespace tubecut::cutout
