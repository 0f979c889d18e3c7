#include "api/catalog/section_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "api/catalog/measures.hpp"
#include "api/wire/field_names.hpp"
#include "core/base/error.hpp"

namespace tubecut::api {
namespace {

using section::Standard;

struct Sides {
  double height, width;
  std::initializer_list<double> walls;
};

// EN 10210-2, annex B: hot finished.
const Sides kHot[] = {
    {40, 40, {3, 4}},
    {50, 50, {3, 4, 5}},
    {60, 60, {3, 4, 5, 6.3}},
    {70, 70, {4, 5, 6.3}},
    {80, 80, {4, 5, 6.3, 8}},
    {90, 90, {4, 5, 6.3, 8}},
    {100, 100, {4, 5, 6.3, 8, 10}},
    {120, 120, {5, 6.3, 8, 10, 12.5}},
    {140, 140, {5, 6.3, 8, 10, 12.5}},
    {150, 150, {5, 6.3, 8, 10, 12.5}},
    {160, 160, {5, 6.3, 8, 10, 12.5}},
    {180, 180, {5, 6.3, 8, 10, 12.5}},
    {200, 200, {5, 6.3, 8, 10, 12.5}},
    {250, 250, {6.3, 8, 10, 12.5}},
    {300, 300, {6.3, 8, 10, 12.5}},
    {50, 30, {3, 4, 5}},
    {60, 40, {3, 4, 5}},
    {80, 40, {3, 4, 5, 6.3}},
    {90, 50, {4, 5, 6.3}},
    {100, 50, {4, 5, 6.3, 8}},
    {100, 60, {4, 5, 6.3, 8}},
    {120, 60, {4, 5, 6.3, 8}},
    {120, 80, {4, 5, 6.3, 8, 10}},
    {140, 80, {4, 5, 6.3, 8, 10}},
    {150, 100, {4, 5, 6.3, 8, 10}},
    {160, 80, {4, 5, 6.3, 8, 10}},
    {180, 100, {5, 6.3, 8, 10}},
    {200, 100, {5, 6.3, 8, 10}},
    {200, 120, {5, 6.3, 8, 10}},
    {250, 150, {6.3, 8, 10, 12.5}},
    {300, 200, {6.3, 8, 10, 12.5}},
};

// EN 10219-2, annex B: cold formed.
const Sides kCold[] = {
    {20, 20, {2}},
    {25, 25, {2}},
    {30, 30, {2, 3}},
    {40, 40, {2, 3, 4}},
    {50, 50, {2, 3, 4, 5}},
    {60, 60, {2, 3, 4, 5}},
    {70, 70, {3, 4, 5}},
    {80, 80, {3, 4, 5, 6}},
    {90, 90, {3, 4, 5, 6}},
    {100, 100, {3, 4, 5, 6, 8}},
    {120, 120, {4, 5, 6, 8, 10}},
    {140, 140, {4, 5, 6, 8, 10}},
    {150, 150, {4, 5, 6, 8, 10}},
    {160, 160, {4, 5, 6, 8, 10}},
    {180, 180, {5, 6, 8, 10}},
    {200, 200, {5, 6, 8, 10, 12.5}},
    {250, 250, {6, 8, 10, 12.5}},
    {300, 300, {6, 8, 10, 12.5}},
    {40, 20, {2, 3}},
    {50, 30, {2, 3, 4}},
    {60, 40, {2, 3, 4, 5}},
    {80, 40, {2, 3, 4, 5}},
    {80, 60, {3, 4, 5}},
    {90, 50, {3, 4, 5}},
    {100, 40, {3, 4, 5}},
    {100, 50, {3, 4, 5, 6}},
    {100, 60, {3, 4, 5, 6}},
    {120, 60, {3, 4, 5, 6}},
    {120, 80, {3, 4, 5, 6, 8}},
    {140, 80, {4, 5, 6, 8}},
    {150, 100, {4, 5, 6, 8}},
    {160, 80, {4, 5, 6, 8}},
    {180, 100, {4, 5, 6, 8, 10}},
    {200, 100, {4, 5, 6, 8, 10}},
    {200, 120, {4, 5, 6, 8, 10}},
    {250, 150, {5, 6, 8, 10}},
    {300, 200, {6, 8, 10}},
};

// ASTM A500, nominal walls.
const Sides kAstm[] = {
    {50.8, 50.8, {3.18, 4.78, 6.35}},         {63.5, 63.5, {3.18, 4.78, 6.35}},
    {76.2, 76.2, {3.18, 4.78, 6.35}},         {101.6, 101.6, {3.18, 4.78, 6.35, 7.95, 9.53}},
    {127, 127, {4.78, 6.35, 7.95, 9.53}},     {152.4, 152.4, {4.78, 6.35, 7.95, 9.53}},
    {203.2, 203.2, {4.78, 6.35, 7.95, 9.53}}, {76.2, 50.8, {3.18, 4.78, 6.35}},
    {101.6, 50.8, {3.18, 4.78, 6.35}},        {152.4, 101.6, {4.78, 6.35, 7.95, 9.53}},
    {203.2, 101.6, {4.78, 6.35, 7.95, 9.53}},
};

struct Series {
  std::span<const Sides> sides;
  Standard standard;
  std::string_view name, edition;
};

std::vector<SectionSize> listed() {
  const Series kSeries[] = {{kHot, Standard::en_10210, "EN 10210", "EN 10210-2:2006"},
                            {kCold, Standard::en_10219, "EN 10219", "EN 10219-2:2006"},
                            {kAstm, Standard::astm_a500, "ASTM A500", "ASTM A500/A500M-21"}};
  std::vector<SectionSize> out;
  for (const auto& series : kSeries)
    for (const auto& [height, width, walls] : series.sides)
      for (const double wall : walls) {
        const auto radii = section::corner_radii(series.standard, wall);
        const bool square = height == width;
        const bool astm = series.standard == Standard::astm_a500;
        out.push_back({.name = std::string(astm     ? "HSS "
                                           : square ? "SHS "
                                                    : "RHS ") +
                               shown(height) + "x" + shown(width) + "x" + shown(wall) + " " +
                               std::string(series.name),
                       .section = {.height = height,
                                   .width = width,
                                   .wall = wall,
                                   .corner = radii.outer,
                                   .inner_corner = radii.inner},
                       .standard = series.edition});
      }
  return out;
}

}  // namespace

std::span<const SectionSize> section_sizes() {
  static const auto kSizes = listed();
  return kSizes;
}

const SectionSize* find_section_size(std::string_view name) {
  const auto sizes = section_sizes();
  const auto found = std::ranges::find(sizes, name, &SectionSize::name);
  return found == sizes.end() ? nullptr : &*found;
}

namespace {

/// A name without blanks, in small letters: people write "shs 50x50x3" and "SHS50X50X3".
std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name)
    if (c != ' ') out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

/// Returns whether a name begins with another as a whole, not within a number of it.
bool begins(const std::string& name, const std::string& with) {
  if (with.empty() || !name.starts_with(with)) return false;
  const char next = name.size() > with.size() ? name[with.size()] : ' ';
  return next != '.' && !(next >= '0' && next <= '9');
}

/// Returns the size with these sides, in either order, whose wall is nearest, of the named standard
/// if there is one; empty if no size has them.
std::string nearest_size(const std::vector<double>& measures, const std::string& meant) {
  const SectionSize* best = nullptr;
  const auto [least, most] = std::minmax(measures[0], measures[1]);
  const auto off = [&](const SectionSize& size) {
    const auto name = plain(size.name);
    const auto standard = name.substr(std::min(name.find("en1"), name.find("astm")));
    return std::pair(meant.find(standard) == std::string::npos,
                     std::abs(size.section.wall - measures[2]));
  };
  for (const auto& size : section_sizes())
    if (same_measure(std::min(size.section.height, size.section.width), least) &&
        same_measure(std::max(size.section.height, size.section.width), most) &&
        (best == nullptr || off(size) < off(*best)))
      best = &size;
  return best == nullptr ? std::string() : best->name;
}

std::vector<std::string> names_of_sizes() {
  std::vector<std::string> out;
  for (const auto& size : section_sizes()) out.push_back(size.name);
  return out;
}

/// Returns the sizes that begin with a plain name.
std::vector<std::string> begun_by(const std::string& meant) {
  auto out = names_of_sizes();
  std::erase_if(out, [&](const std::string& size) { return !begins(plain(size), meant); });
  return out;
}

/// Returns the plain name of a square that is named by one side, as "shs40x3", with both.
std::string with_both_sides(const std::string& meant) {
  const auto first = std::ranges::find_if(meant, [](char c) { return c >= '0' && c <= '9'; });
  const auto end = std::find(first, meant.end(), 'x');
  return std::string(meant.begin(), end) + "x" + std::string(first, meant.end());
}

}  // namespace

std::string section_size_hint(std::string_view name) {
  const auto meant = plain(name);
  const auto measures = measures_in(name);
  auto begun = begun_by(meant);
  if (begun.empty() && measures.size() == 2) begun = begun_by(with_both_sides(meant));
  if (begun.size() > 1) {
    std::string out = "did you mean one of " + begun.front();
    for (std::size_t i = 1; i < begun.size(); ++i) out += ", " + begun[i];
    return out + "?";
  }
  const auto near = !begun.empty()         ? begun.front()
                    : measures.size() == 3 ? nearest_size(measures, meant)
                                           : nearest_name(name, names_of_sizes());
  return near.empty() ? "GET /v1/tubes lists the sizes; state any other by kind, height_mm, "
                        "width_mm, wall_mm and corners"
                      : "did you mean " + near + "?";
}

bool is_section_size(std::string_view name) {
  const auto meant = plain(name);
  return std::ranges::any_of(std::array{"shs", "rhs", "hss"},
                             [&](std::string_view kind) { return meant.starts_with(kind); });
}

}  // namespace tubecut::api
