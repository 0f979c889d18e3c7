#include "core/cutout/axis_line.hpp"

#include <cmath>

#include "core/base/stop.hpp"
#include "core/math/polygon.hpp"

namespace tubecut::cutout {
namespace {

constexpr double kLineCrossed = 1e-9;  // of the area within the torch's line

}  // namespace

std::optional<LineCrossing> crossing(const std::vector<AxisRow>& one,
                                     const std::vector<AxisRow>& other) {
  for (std::size_t i = one.size(); i-- > 1;)
    for (std::size_t j = 0; j + 1 < other.size(); ++j) {
      const Flat a = one[i - 1].torch, b = one[i].torch - a;
      const Flat c = other[j].torch, d = other[j + 1].torch - c;
      const double of = cross(b, d);
      if (of == 0.0) continue;
      const double u = cross(c - a, d) / of, v = cross(c - a, b) / of;
      if (u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0)
        return LineCrossing{i - 1, j + 1, a + u * b};
    }
  return {};
}

void turn_in_hollows(double kerf, std::vector<AxisRow>& rows) {
  const auto count = rows.size();
  const auto torch = [&](std::size_t i) -> Flat& { return rows[i % count].torch; };
  for (std::size_t i = 0; i < count; ++i) {
    double way = 0.0;
    for (std::size_t j = i + 2; j + 1 < i + count && way < 2.0 * kerf; ++j) {
      way += (torch(j) - torch(j - 1)).norm();
      const Flat a = torch(i), b = torch(i + 1) - a;
      const Flat c = torch(j), d = torch(j + 1) - c;
      const double of = cross(b, d);
      const double u = cross(c - a, d) / of, v = cross(c - a, b) / of;
      if (of == 0.0 || !(u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0)) continue;
      const Flat met = a + u * b;
      for (std::size_t k = i + 1; k <= j; ++k) torch(k) = met;
      break;
    }
  }
}

Result<void> check_line(const std::vector<AxisRow>& rows) {
  math::Polygon line;
  for (const auto& row : rows) {
    line.x.push_back(row.torch.x());
    line.y.push_back(row.torch.y());
  }
  double twice = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    twice += cross(rows[i].torch, rows[(i + 1) % rows.size()].torch);
  const double crossed = math::crossed_area(line);
  if (stopped()) return fail({.code = ErrorCode::cancelled});  // because the area is half summed
  if (twice > 0.0 && !(crossed > kLineCrossed * twice)) return {};
  return fail({.code = ErrorCode::out_of_range, .hint = "somewhere it is narrower than the kerf"});
}

}  // namespace tubecut::cutout
