#include "core/joint/cutters/cutter.hpp"

#include <algorithm>

#include "core/joint/node/sheets.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::joint {

Result<PreparedCutter> prepare(const Cutter& cutter) {
  return by_kind(cutter, [](const auto& kind) -> Result<PreparedCutter> { return kind.prepare(); });
}

TurnAboutAxis turn_about_axis(Angle by) { return {math::turn_about_z(by.rad()), by}; }

std::optional<Bearing> bearing(const Partner& partner) {
  return by_kind(partner, [](const auto& kind) { return kind.bearing(); });
}

double sin_inclination(const PreparedCutter& cutter) {
  return by_kind(cutter, [&](const auto& kind) { return kind.sine(); });
}
std::optional<double> upper_sheet(const PreparedCutter& cutter, const Generator& line) {
  return by_kind(cutter, [&](const auto& kind) { return kind.upper_sheet(line); });
}
double continued_sheet(const PreparedCutter& cutter, const Generator& line) {
  return by_kind(cutter, [&](const auto& kind) { return kind.continued_sheet(line); });
}
Hit continued_hit(const PreparedCutter& cutter, const Generator& line) {
  return by_kind(cutter, [&](const auto& kind) { return kind.continued_hit(line); });
}
double silhouette_height(const PreparedCutter& cutter, const Generator& line) {
  return by_kind(cutter, [&](const auto& kind) { return kind.silhouette_height(line); });
}
double silhouette_slope(const PreparedCutter& cutter, const Generator& line) {
  return by_kind(cutter, [&](const auto& kind) { return kind.silhouette_slope(line); });
}
Hit hit_at_corner(const PreparedCutter& cutter, const Generator& line, Side side) {
  return by_kind(cutter, [&](const auto& kind) { return kind.hit_at_corner(line, side); });
}
Eigen::Vector3d published_normal(const PreparedCutter& cutter, const Generator& line) {
  return by_kind(cutter, [&](const auto& kind) { return kind.published_normal(line); });
}
Met met(const PreparedCutter& cutter, double rho) {
  return by_kind(cutter, [&](const auto& kind) { return kind.met(rho); });
}
double rounding_size(const PreparedCutter& cutter, double rho) {
  return by_kind(cutter, [&](const auto& kind) { return kind.size(rho); });
}
double event_noise(std::span<const Sheets> parts, double size) {
  constexpr double kCurved = 1e-7;  // relative; at a silhouette it is the square root of rounding
  constexpr double kFlat = 3e-11;   // times the size of a flat, which grows with its slope: of phi
  if (parts.empty()) return kCurved * size;
  double out = 0.0;
  for (const auto& part : parts) out = std::max(out, (part.curved ? kCurved : kFlat) * part.size);
  return out;
}
std::vector<Sheets> sheets(const PreparedCutter& cutter, double rho) {
  return by_kind(cutter, [&](const auto& kind) { return kind.sheets(rho); });
}
std::vector<double> silhouettes(const PreparedCutter& cutter, double rho) {
  return by_kind(cutter, [&](const auto& kind) { return kind.silhouettes(rho); });
}
std::vector<double> kinks(const PreparedCutter& cutter, double rho) {
  return by_kind(cutter, [&](const auto& kind) { return kind.kinks(rho); });
}
Heights heights_near(const PreparedCutter& cutter, const Generator& line, double off) {
  return by_kind(cutter, [&](const auto& kind) { return kind.heights_near(line, off); });
}
double steepest(const PreparedCutter& cutter, const Wall& wall, const Generator& inner,
                double z_root) {
  return by_kind(cutter, [&](const auto& kind) { return kind.steepest(wall, inner, z_root); });
}
double support(const PreparedCutter& cutter, const Wall& wall, const Generator& inner,
               double slope) {
  return by_kind(cutter, [&](const auto& kind) { return kind.support(wall, inner, slope); });
}

std::optional<Hit> hit(const PreparedCutter& cutter, const Generator& line) {
  if (!upper_sheet(cutter, line)) return std::nullopt;
  return continued_hit(cutter, line);
}

std::optional<double> upper_sheet(const Cutter& cutter, double rho, Angle phi) {
  const auto prepared = prepare(cutter);
  if (!prepared) return std::nullopt;
  return upper_sheet(*prepared, generator_at(rho, phi.rad()));
}

std::optional<Hit> hit(const Cutter& cutter, double rho, Angle phi) {
  const auto prepared = prepare(cutter);
  if (!prepared) return std::nullopt;
  return hit(*prepared, generator_at(rho, phi.rad()));
}

}  // namespace tubecut::joint
