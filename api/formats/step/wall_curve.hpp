#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "api/formats/step/wall_spline.hpp"
#include "core/bevel/beam/penetration.hpp"

namespace tubecut::api {

/// The edges of a cut wall as curves on their cylinders.
///
/// `straight`: the answer's curve, straight in (phi, z) from row to row. If the rows are so close
/// that a smooth curve stays within kSplineError of those lines, it is that curve, shifted slightly
/// off the rows so that both sides of the lines lose equally; elsewhere every row is a corner.
/// `smooth`: through the rows, with one curvature at each, and corners at the given ones and at
/// rows where an edge turns far more than at the adjacent ones.
class WallCurve {
 public:
  /// A plane that an edge lies in instead of on its cylinder: `distance` from the tube's axis,
  /// whose normal points to phi.
  struct EdgePlane {
    double phi = 0.0, distance = 0.0;
  };
  using EdgePlanes = std::vector<std::optional<EdgePlane>>;  // of each edge, or empty

  /// Row and fraction of the distance to the next.
  struct RowPosition {
    std::size_t row = 0;
    double share = 0.0;
  };

  [[nodiscard]] static WallCurve straight(const bevel::CutWall& wall,
                                          const EdgePlanes& planes = {});
  [[nodiscard]] static WallCurve smooth(const bevel::CutWall& wall,
                                        const std::vector<bool>& corners,
                                        const EdgePlanes& planes = {});

  [[nodiscard]] std::size_t rows() const { return length_.size(); }
  [[nodiscard]] std::size_t edges() const { return edges_.size(); }
  /// (phi, z) of an edge.
  [[nodiscard]] Eigen::Vector2d at(std::size_t edge, const RowPosition& position) const;
  /// How far along the rows, mm; `around()` in all.
  [[nodiscard]] double along(const RowPosition& position) const;
  [[nodiscard]] double around() const { return around_; }
  /// Returns the points, ascending, at which its edges have two slopes.
  [[nodiscard]] std::vector<RowPosition> corners() const;
  /// Returns the points at which an edge crosses the generator phi, in any turn.
  [[nodiscard]] std::vector<RowPosition> crossings(std::size_t edge, double phi) const;

  /// `stations`: knots of it, at least one, ascending; it begins at the first.
  [[nodiscard]] WallSpline spline(const std::vector<RowPosition>& stations) const;

 private:
  struct Edge {
    double radius = 0.0;
    double widest = 0.0;                             // rad, of a span
    std::optional<EdgePlane> plane = {};             // that it lies in
    std::vector<Eigen::Vector2d> row;                // as given
    std::vector<Eigen::Vector2d> gap;                // from each to the next
    std::vector<Eigen::Vector2d> knot;               // position of the curve there
    std::vector<Eigen::Vector2d> arriving, leaving;  // its slopes there, per mm along the rows

    /// The place of a (phi, z) of it.
    [[nodiscard]] Eigen::Vector3d in_space(const Eigen::Vector2d& flat) const;
    /// How far a place is off its cylinder or plane.
    [[nodiscard]] double off(const Eigen::Vector3d& place) const;
  };
  /// Position of an edge, in (phi, z) or in space, and its slopes on both sides, per mm along the
  /// rows.
  template <typename Point>
  struct Passing {
    Point at = Point::Zero(), before = Point::Zero(), beyond = Point::Zero();
  };
  struct Passed {
    Passing<Eigen::Vector2d> flat;
    Passing<Eigen::Vector3d> space;
  };
  /// A point at which a span may begin: a row, a station, or one in a long gap.
  struct Node {
    RowPosition position;
    double along = 0.0;  // from the first station
    bool corner = false, station = false;
    double turn = 0.0;  // 1 beyond the last row
    std::vector<Passed> edges;
  };
  /// From one knot to the next: a cubic of each edge.
  struct Span;
  template <typename Point>
  using Cubic = std::array<Point, 4>;
  using Bezier = Cubic<Eigen::Vector3d>;
  using Flat = Cubic<Eigen::Vector2d>;
  /// One span in space and in (phi, z): at every parameter the same place.
  struct Pair {
    Bezier space;
    Flat flat;
  };

  WallCurve(const bevel::CutWall& wall, const EdgePlanes& planes);
  struct Bend;
  [[nodiscard]] std::vector<Bend> bends(const Edge& edge) const;
  void find_lines();
  void find_kinks();
  void lay(bool centred);
  void bend_evenly(Edge& edge) const;
  [[nodiscard]] Eigen::Vector2d laid_gap(const Edge& edge, std::size_t row) const;
  [[nodiscard]] Passing<Eigen::Vector2d> pass(const Edge& edge, const RowPosition& position) const;
  [[nodiscard]] Node node(const RowPosition& position) const;
  void lay_in_space(std::vector<Node>& nodes) const;
  [[nodiscard]] std::vector<Node> nodes(const std::vector<RowPosition>& stations) const;
  /// How far round an edge goes from one node to the next, rad.
  [[nodiscard]] double turned(std::size_t edge, const Node& from, const Node& to) const;
  [[nodiscard]] Pair cubics(std::size_t edge, const Node& from, const Node& to) const;
  [[nodiscard]] std::size_t farthest(const std::vector<Node>& nodes, std::size_t from) const;
  /// Returns the node at a distance along the rows from the first station, which is at `origin`.
  [[nodiscard]] Node node_at(double from_station, double origin) const;
  /// Returns whether the cubics between two nodes stay on their cylinders.
  [[nodiscard]] bool on_cylinders(const Node& from, const Node& to) const;
  /// Appends the span between two nodes. If it leaves its cylinders, both halves, and so on up to
  /// `halvings` times.
  void add_spans(const Node& from, const Node& to, double origin, int halvings,
                 std::vector<Span>& out) const;
  [[nodiscard]] std::vector<Span> spans(const std::vector<Node>& nodes) const;
  [[nodiscard]] static std::vector<Span> graded(std::vector<Span> spans);
  [[nodiscard]] bool fits(const std::vector<Node>& nodes, std::size_t from, std::size_t to) const;
  [[nodiscard]] bool near(const Bezier& curve, const Eigen::Vector3d& point, double u) const;

  std::vector<Edge> edges_;
  std::vector<double> length_, along_;  // of the gap behind each row; up to each row
  std::vector<bool> corner_;
  double turn_ = 0.0, around_ = 0.0;
  double off_cylinder_ = 0.0, off_rows_ = 0.0;  // permitted deviation of a span, mm
  std::optional<double> off_flat_;  // and of its twin in (phi, z), if that is printed, mm
};

}  // namespace tubecut::api
