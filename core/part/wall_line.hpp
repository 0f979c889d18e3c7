#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace tubecut::part {

/// A place on a developed wall, mm: round, and along.
using WallPoint = Eigen::Vector2d;

inline constexpr double kFar = std::numeric_limits<double>::infinity();

/// The shortest way from one line to another.
struct WallWay {
  double length = kFar;
  WallPoint from = WallPoint::Zero(), to = WallPoint::Zero();
};

/// An upright box.
struct WallBox {
  WallPoint least = WallPoint::Constant(kFar), most = WallPoint::Constant(-kFar);

  void take(const WallPoint& p) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  /// A bound of the way to another that is moved by `shift`, from below.
  [[nodiscard]] double apart(const WallBox& other, const WallPoint& shift) const;
};

/// A line of straight segments on a developed wall, in blocks of neighbours that lie in a box each.
class WallLine {
 public:
  WallLine(std::vector<WallPoint> points, bool closed);

  [[nodiscard]] const std::vector<WallPoint>& points() const { return points_; }
  [[nodiscard]] const WallBox& box() const { return whole_; }
  /// Whether a place lies within the closed line.
  [[nodiscard]] bool holds(const WallPoint& p) const;
  /// The shortest way to another line that is moved by `shift`, if it is shorter than `best`.
  /// Cost  the square of the blocks, and the segments of those that are near.
  void shorten(const WallLine& other, const WallPoint& shift, WallWay& best) const;

 private:
  struct LineSegment {
    WallPoint a, b;
  };
  static constexpr std::size_t kBlock = 32;

  static WallWay way(const WallPoint& p, const LineSegment& to);
  static WallWay way(const LineSegment& one, const LineSegment& other);
  [[nodiscard]] std::span<const LineSegment> block(std::size_t i) const;
  [[nodiscard]] double reach(const WallLine& other, const WallPoint& shift) const;

  std::vector<WallPoint> points_;
  std::vector<LineSegment> segments_;
  std::vector<WallBox> boxes_;
  WallBox whole_;
};

/// Whether one of two closed lines, the other moved by `shift`, lies within the other or holds its
/// first place.
[[nodiscard]] inline bool nested(const WallLine& a, const WallLine& b, const WallPoint& shift) {
  return a.holds(b.points().front() + shift) || b.holds(a.points().front() - shift);
}

}  // namespace tubecut::part
