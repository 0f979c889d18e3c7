#pragma once

#include <cstddef>
#include <vector>

/// Polylines on a developed surface.
namespace tubecut::motion {

/// A point or direction of a developed surface: s = radius * phi, and z.
struct Flat {
  double s = 0.0;
  double z = 0.0;
};

/// Computes the distance from p to the straight line between a and b, mm.
[[nodiscard]] double distance(Flat p, Flat a, Flat b);

struct Box {
  Flat low, high;
};

/// Returns a lower bound of the distance to anything in the box, mm.
[[nodiscard]] double least_distance(Flat p, const Box& box);
/// Returns an upper bound of it.
[[nodiscard]] double most_distance(Flat p, const Box& box);

/// A polyline's points, with boxes that each contain a fixed number of its chords, so that a search
/// for the nearest checks few of them. A polyline of one point has a chord of zero length.
struct Chords {
  static constexpr std::size_t kInBox = 64;

  explicit Chords(std::vector<Flat> line);

  std::vector<Flat> points;
  std::vector<Box> boxes;
};

/// Calls `see(a, b)` with the ends of every chord of a box.
template <class See>
void each_chord(const Chords& line, std::size_t box, const See& see) {
  const std::size_t from = box * Chords::kInBox;
  const std::size_t last = line.points.size() - 1;
  for (std::size_t i = from; i < from + Chords::kInBox && (i < last || i == 0); ++i)
    see(line.points[i], line.points[i < last ? i + 1 : i]);
}

/// Returns the smaller of `nearest` and the distance to a chord, which is computed only if it can
/// be smaller.
[[nodiscard]] double nearer(double nearest, Flat p, Flat a, Flat b);
/// The same for a whole polyline.
[[nodiscard]] double nearer(double nearest, Flat p, const Chords& line);

}  // namespace tubecut::motion
