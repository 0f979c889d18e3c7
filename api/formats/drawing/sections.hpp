#pragma once

#include <string>
#include <vector>

#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/sheet.hpp"

namespace tubecut::api {

/// The cut wall in one plane: across from the bore (0) to the outer wall, along the tube (z).
struct WallSection {
  std::string name;
  std::vector<DrawingPoint> cut;  // from the inner edge to the outer one; x across, y along
  std::string angle;              // of the cut, for the table
};

/// The sections of one cut, evenly round it.
struct SectionSet {
  std::string title;
  double wall = 0.0;
  std::string along;        // meaning of y
  std::string angle = "B";  // name of the cut's angle, between its line and square to the wall
  SheetFacts facts;
  std::vector<WallSection> sections;
};

[[nodiscard]] SectionSet sections_of(const bevel::TableSpec& spec, const bevel::Table& table);
[[nodiscard]] SectionSet sections_of(const joint::IntersectionSpec& spec,
                                     const joint::Intersection& cut);
[[nodiscard]] SectionSet sections_of(const NamedHole& spec, const bevel::HoleCut& cut);

/// Eight sections through the wall on A4, all at one usual scale, with a table of their figures.
[[nodiscard]] Canvas section_sheet(const SectionSet& set, const Caption& caption);

}  // namespace tubecut::api
