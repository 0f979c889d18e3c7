#pragma once

#include <cstddef>
#include <vector>

/// Lines on a developed surface, straight from point to point.
namespace tubecut::motion {

/// A point or direction of a developed surface: s = radius * phi, and z.
struct Flat {
  double s = 0.0;
  double z = 0.0;
};

/// From p to the straight line between a and b, mm.
[[nodiscard]] double distance(Flat p, Flat a, Flat b);

struct Box {
  Flat low, high;
};

/// No more than the distance to anything in the box, mm.
[[nodiscard]] double least_distance(Flat p, const Box& box);
/// No less than it.
[[nodiscard]] double most_distance(Flat p, const Box& box);

/// A line's points, and boxes that hold so many of its chords each: what asks for the nearest looks
/// into few of them. A line of one point has a chord of no length.
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

/// The lesser of `nearest` and the distance to a chord, which is worked out only where it can be.
[[nodiscard]] double nearer(double nearest, Flat p, Flat a, Flat b);
/// The same of a whole line.
[[nodiscard]] double nearer(double nearest, Flat p, const Chords& line);

}  // namespace tubecut::motion
