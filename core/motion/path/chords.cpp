#include "core/motion/path/chords.hpp"

#include <algorithm>
#include <utility>

#include "core/base/elementary.hpp"

namespace tubecut::motion {
namespace {

Box box_of(Flat a, Flat b) {
  const auto [low_s, high_s] = std::minmax(a.s, b.s);
  const auto [low_z, high_z] = std::minmax(a.z, b.z);
  return {{low_s, low_z}, {high_s, high_z}};
}

Box both(const Box& a, const Box& b) {
  return {{std::min(a.low.s, b.low.s), std::min(a.low.z, b.low.z)},
          {std::max(a.high.s, b.high.s), std::max(a.high.z, b.high.z)}};
}

}  // namespace

double distance(Flat p, Flat a, Flat b) {
  const double s = b.s - a.s, z = b.z - a.z;
  const double square = s * s + z * z;
  const double along = square > 0.0 ? ((p.s - a.s) * s + (p.z - a.z) * z) / square : 0.0;
  const double k = std::clamp(along, 0.0, 1.0);
  return elementary::hypot(p.s - a.s - k * s, p.z - a.z - k * z);
}

double least_distance(Flat p, const Box& box) {
  return std::max({box.low.s - p.s, p.s - box.high.s, box.low.z - p.z, p.z - box.high.z});
}

double most_distance(Flat p, const Box& box) {
  return elementary::hypot(std::max(p.s - box.low.s, box.high.s - p.s),
                           std::max(p.z - box.low.z, box.high.z - p.z));
}

Chords::Chords(std::vector<Flat> line) : points(std::move(line)) {
  const std::size_t chords = std::max<std::size_t>(points.size(), 2) - 1;
  for (std::size_t k = 0; k * kInBox < chords && !points.empty(); ++k) {
    const Flat first = points[k * kInBox];
    Box box{first, first};
    each_chord(*this, k, [&](Flat a, Flat b) { box = both(box, box_of(a, b)); });
    boxes.push_back(box);
  }
}

double nearer(double nearest, Flat p, Flat a, Flat b) {
  return least_distance(p, box_of(a, b)) < nearest ? std::min(nearest, distance(p, a, b)) : nearest;
}

double nearer(double nearest, Flat p, const Chords& line) {
  for (std::size_t k = 0; k < line.boxes.size(); ++k)
    if (least_distance(p, line.boxes[k]) < nearest)
      each_chord(line, k, [&](Flat a, Flat b) { nearest = nearer(nearest, p, a, b); });
  return nearest;
}

}  // namespace tubecut::motion
