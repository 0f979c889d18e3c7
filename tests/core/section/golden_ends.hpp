#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/joint/cutters/cutter.hpp"
#include "core/joint/intersection.hpp"
#include "core/section/section.hpp"
#include "tests/support/golden.hpp"

/// Reads tests/golden/sections.json.
namespace tubecut::testing {

inline section::Section golden_section(const api::Json& json) {
  return {.height = number(json, "H"),
          .width = number(json, "W"),
          .wall = number(json, "t"),
          .corner = number(json, "ro"),
          .inner_corner = number(json, "ri")};
}

inline double between(std::mt19937& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

/// A tube with sides from 60 mm, its corners by one of the standards.
inline section::Section drawn_section(std::mt19937& random, double widest, double thinnest) {
  const double height = between(random, 60, widest), width = between(random, 60, widest);
  const double wall = between(random, thinnest, 6.0);
  const auto radii = section::corner_radii(static_cast<section::Standard>(random() % 3), wall);
  return {height, width, wall, radii.outer, radii.inner};
}

inline Eigen::Vector3d golden_vector(const api::Json& json, std::string_view name) {
  const auto v = numbers(json, name);
  return {v.at(0), v.at(1), v.at(2)};
}

inline joint::Partner golden_partner(const api::Json& json) {
  const auto kind = text(json, "kind");
  if (kind == "tube")
    return joint::TubeCutter{.radius = number(json, "r"),
                             .inclination = Angle::deg(number(json, "inclination_deg")),
                             .clocking = Angle::deg(number(json, "clocking_deg")),
                             .offset = number(json, "offset"),
                             .height = number(json, "height")};
  if (kind == "plane")
    return joint::PlaneCutter{.point = golden_vector(json, "point"),
                              .normal = golden_vector(json, "normal")};
  if (kind == "cone")
    return joint::ConeCutter{.radius = number(json, "r"),
                             .half_angle = Angle::deg(number(json, "half_angle_deg")),
                             .point = golden_vector(json, "point"),
                             .direction = golden_vector(json, "direction")};
  return joint::RectangularTubeCutter{.width = number(json, "w"),
                                      .height = number(json, "h"),
                                      .corner = number(json, "corner"),
                                      .point = golden_vector(json, "point"),
                                      .direction = golden_vector(json, "direction"),
                                      .up = golden_vector(json, "up")};
}

struct GoldenEnd {
  std::string name;
  section::Section section;
  std::vector<joint::Partner> partners;
  const api::Json* json;
};

inline std::vector<GoldenEnd> golden_ends(const api::Json& file) {
  std::vector<GoldenEnd> out;
  for (const auto& end : *at(file, "ends").as<api::Json::Array>()) {
    GoldenEnd one{.name = text(end, "name"),
                  .section = golden_section(at(end, "section")),
                  .partners = {},
                  .json = &end};
    for (const auto& partner : *at(end, "partners").as<api::Json::Array>())
      one.partners.push_back(golden_partner(partner));
    out.push_back(std::move(one));
  }
  return out;
}

/// A column whose entries may be null: NaN there.
inline std::vector<double> golden_column(const api::Json& json, std::string_view name) {
  std::vector<double> out;
  for (const auto& one : *at(json, name).as<api::Json::Array>())
    out.push_back(one.as<double>() != nullptr ? *one.as<double>() : std::nan(""));
  return out;
}

}  // namespace tubecut::testing
