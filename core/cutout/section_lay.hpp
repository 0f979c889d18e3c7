#pragma once

#include <cstdint>
#include <vector>

#include "core/cutout/chain.hpp"
#include "core/section/section.hpp"

/// How a local plane lies on a section where it reaches over corners.
namespace tubecut::cutout {

/// How a local plane lies on a tube, about its anchor.
enum class Lay : std::uint8_t {
  developed,  // on the outside, the wall square to it: b is way round the outside
  prism,      // straight along the anchor's normal
  bored,  // the prism's edge on the bore, the wall square from there: a torch that does not tilt
  flat,   // on one face of a section: the same shape on the outside and on the bore
};

/// One side of an outline as seen along a direction: where lines along it leave it.
class Sight {
 public:
  /// From outside, against `from`; its places have y along the tangent of `from`.
  Sight(const section::Curve& curve, const section::Station& from);

  /// s of the outermost place at y, continuous, about that of `from`.
  [[nodiscard]] double s(double y) const;
  /// The least and the greatest y, and those where the curvature jumps.
  [[nodiscard]] const std::vector<double>& breaks() const { return breaks_; }
  [[nodiscard]] double y_of(const Eigen::Vector2d& place) const { return place.dot(tangent_); }
  [[nodiscard]] bool sees(const section::Station& at) const;

 private:
  struct Piece {
    double y = 0.0, s = 0.0, nu = 0.0;  // where it begins
    double radius = 0.0, centre = 0.0;  // of an arc, the centre's y
    double share = 1.0;                 // of a flat: of y to the way
  };
  void add(const section::Curve& curve, const section::OutlineSegment& segment, int turn);

  Eigen::Vector2d normal_, tangent_;
  double nu_;
  std::vector<Piece> pieces_;
  std::vector<double> breaks_;
};

/// A place of a cut-out's edge on both surfaces: ways round counted as s, continuous.
struct EdgePlace {
  double s = 0.0, s_bore = 0.0;
  section::Station outer, bore;
};

/// Lays b on both surfaces of a section, about an anchor that may lie on a corner.
/// Source  docs/theory/cutouts.md, section 11.
class SectionLay {
 public:
  /// `s`: the anchor's on the near side.
  SectionLay(const section::Wall& wall, double s, Lay lay, bool far);

  [[nodiscard]] const section::Wall& wall() const { return wall_; }
  [[nodiscard]] EdgePlace at(double b) const;
  /// The place on this side at b = 0.
  [[nodiscard]] const EdgePlace& anchor() const { return anchor_; }
  [[nodiscard]] double s_of_spec() const { return s_; }
  /// 1, or -1 on the far side: of b to s.
  [[nodiscard]] double sense() const { return far_ ? -1.0 : 1.0; }

  /// Way round from the anchor, positive as b grows.
  [[nodiscard]] double way(double b, bool outer) const;
  /// The same on the bore of a line square to the outside at a way from the anchor.
  [[nodiscard]] double way_on_bore(double way) const;
  /// How far the outside's normal at b is turned from the anchor's, rad, as s grows.
  [[nodiscard]] double lean(double b) const;
  /// How much a step of b is longer on the outside, and on the bore.
  struct Rates {
    double outer = 1.0, bore = 1.0;
  };
  [[nodiscard]] Rates rates(double b) const;
  /// The wall's area from b = 0 on, mm^2, but for a constant and its sign.
  [[nodiscard]] double area(double b) const;
  /// How this area grows with b, by the wall's own lines.
  [[nodiscard]] double depth(double b) const;
  /// b where the rates jump, ascending.
  [[nodiscard]] const std::vector<double>& breaks() const { return breaks_; }
  /// How far b may reach to both sides so that a prism's line crosses the bore.
  [[nodiscard]] Bounds reach() const;

  /// A beam square to the outside whose edge touches the wall at `edge`: the direction from its
  /// axis to there in its own cross-section, (z, round as b grows), where the wall's edge has the
  /// normal `m` on the developed outside.
  [[nodiscard]] Flat contact(double edge, const Flat& m, double kerf) const;
  /// The way of that axis, where the contact is `side` to the side of b, mm.
  [[nodiscard]] double axis(double edge, double side) const;
  /// The widest kerf that leaves the neighbouring wall alone.
  [[nodiscard]] double most_kerf() const;

 private:
  [[nodiscard]] double y(double b) const { return far_ ? -(y_ + b) : y_ + b; }
  [[nodiscard]] double bore_of(double s) const;
  [[nodiscard]] double outside_of(double s_bore) const;
  void find_breaks();

  section::Wall wall_;
  double s_;
  Lay lay_;
  bool far_;
  section::Station from_;  // what is seen along
  Sight outer_, bore_;
  double y_;
  EdgePlace anchor_;
  std::vector<double> breaks_;
};

/// A chain with its segments divided at these b.
[[nodiscard]] Chain divided(const Chain& chain, const std::vector<double>& breaks);
/// A b within a divided segment, next to the break that it may lie on.
[[nodiscard]] double inside(const Segment& s, double b);
/// Shares of a divided segment between which Gauss serves: finer towards its ends and towards where
/// it turns back across, because the way round may bend as a square root does there.
[[nodiscard]] std::vector<double> cells(const Segment& s);

}  // namespace tubecut::cutout
