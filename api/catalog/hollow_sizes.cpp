#include "api/catalog/hollow_sizes.hpp"

#include <algorithm>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "api/wire/json.hpp"

namespace tubecut::api {
namespace {

struct Hollow {
  double outer_diameter;
  std::initializer_list<double> walls;
};

// EN 10210-2, annex B, circular hollow sections.
const Hollow kHollows[] = {
    {21.3, {2.3, 2.6, 3.2}},
    {26.9, {2.3, 2.6, 3.2}},
    {33.7, {2.6, 3.2, 4.0}},
    {42.4, {2.6, 3.2, 4.0}},
    {48.3, {2.6, 3.2, 4.0, 5.0}},
    {60.3, {2.6, 3.2, 4.0, 5.0}},
    {76.1, {2.6, 3.2, 4.0, 5.0}},
    {88.9, {3.2, 4.0, 5.0, 6.3}},
    {101.6, {3.2, 4.0, 5.0, 6.3, 8.0, 10.0}},
    {114.3, {3.2, 4.0, 5.0, 6.3, 8.0, 10.0}},
    {139.7, {4.0, 5.0, 6.3, 8.0, 10.0, 12.5}},
    {168.3, {4.0, 5.0, 6.3, 8.0, 10.0, 12.5}},
    {177.8, {5.0, 6.3, 8.0, 10.0, 12.5}},
    {193.7, {5.0, 6.3, 8.0, 10.0, 12.5, 16.0}},
    {219.1, {5.0, 6.3, 8.0, 10.0, 12.5, 16.0, 20.0}},
    {244.5, {5.0, 6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0}},
    {273.0, {5.0, 6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0}},
    {323.9, {5.0, 6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0}},
    {355.6, {6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0}},
    {406.4, {6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 30.0, 40.0}},
    {457.0, {6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 30.0, 40.0}},
    {508.0, {6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 30.0, 40.0, 50.0}},
    {610.0, {6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 30.0, 40.0, 50.0}},
    {711.0, {6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0}},
};

// EN 10219-2, annex B: the thin walls that EN 10210-2 does not have.
const Hollow kColdHollows[] = {
    {21.3, {2.0, 2.5, 3.0}}, {26.9, {2.0, 2.5, 3.0}}, {33.7, {2.0, 2.5, 3.0}},
    {42.4, {2.0, 2.5, 3.0}}, {48.3, {2.0, 2.5, 3.0}}, {60.3, {2.0, 2.5, 3.0}},
    {76.1, {2.0, 2.5, 3.0}}, {88.9, {2.0, 2.5, 3.0}}, {101.6, {2.5, 3.0}},
    {114.3, {2.5, 3.0}},     {139.7, {3.0}},          {168.3, {3.0}}};

// EN 10255, medium and heavy series: the pipe of handrails.
const Hollow kThreadable[] = {
    {21.3, {2.6, 3.2}},  {26.9, {2.6, 3.2}},  {33.7, {3.2, 4.0}},  {42.4, {3.2, 4.0}},
    {48.3, {3.2, 4.0}},  {60.3, {3.6, 4.5}},  {76.1, {3.6, 4.5}},  {88.9, {4.0, 5.0}},
    {114.3, {4.5, 5.4}}, {139.7, {5.0, 5.4}}, {165.1, {5.0, 5.4}},
};

struct HollowSeries {
  std::span<const Hollow> hollows;
  std::string_view standard;
};
/// A size of several standards is listed once, by the first.
const HollowSeries kHollowSeries[] = {{kHollows, "EN 10210-2:2006"},
                                      {kColdHollows, "EN 10219-2:2006"},
                                      {kThreadable, "EN 10255:2004"}};

void add(const HollowSeries& series, std::vector<TubeSize>& out) {
  for (const auto& hollow : series.hollows)
    for (const double wall : hollow.walls) {
      std::string name = "CHS ";
      append_number(name, hollow.outer_diameter);
      name += 'x';
      append_number(name, wall);
      if (std::ranges::find(out, name, &TubeSize::name) == out.end())
        out.push_back({std::move(name), hollow.outer_diameter, wall, series.standard});
    }
}

}  // namespace

void add_hollow_sizes(std::vector<TubeSize>& sizes) {
  for (const auto& series : kHollowSeries) add(series, sizes);
}

}  // namespace tubecut::api
