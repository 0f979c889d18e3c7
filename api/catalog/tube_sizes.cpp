#include "api/catalog/tube_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>
#include <vector>

#include "api/catalog/hollow_sizes.hpp"
#include "api/catalog/measures.hpp"
#include "api/catalog/section_sizes.hpp"
#include "api/wire/field_names.hpp"

namespace tubecut::api {
namespace {

constexpr std::string_view kAsme = "ASME B36.10M-2018";

struct Schedule {
  std::string_view name;
  double wall;
};
struct Nominal {
  std::string_view nps;
  double outer_diameter;
  std::initializer_list<Schedule> schedules;
};

// ASME B36.10M, table 1, SI columns. STD, XS and XXS are weight classes; a number is a schedule.
const Nominal kNominals[] = {
    {"1/8", 10.3, {{"SCH 40", 1.73}, {"STD", 1.73}, {"SCH 80", 2.41}, {"XS", 2.41}}},
    {"1/4", 13.7, {{"SCH 40", 2.24}, {"STD", 2.24}, {"SCH 80", 3.02}, {"XS", 3.02}}},
    {"3/8", 17.1, {{"SCH 40", 2.31}, {"STD", 2.31}, {"SCH 80", 3.20}, {"XS", 3.20}}},
    {"1/2",
     21.3,
     {{"SCH 40", 2.77},
      {"STD", 2.77},
      {"SCH 80", 3.73},
      {"XS", 3.73},
      {"SCH 160", 4.78},
      {"XXS", 7.47}}},
    {"3/4",
     26.7,
     {{"SCH 40", 2.87},
      {"STD", 2.87},
      {"SCH 80", 3.91},
      {"XS", 3.91},
      {"SCH 160", 5.56},
      {"XXS", 7.82}}},
    {"1",
     33.4,
     {{"SCH 40", 3.38},
      {"STD", 3.38},
      {"SCH 80", 4.55},
      {"XS", 4.55},
      {"SCH 160", 6.35},
      {"XXS", 9.09}}},
    {"1-1/4",
     42.2,
     {{"SCH 40", 3.56},
      {"STD", 3.56},
      {"SCH 80", 4.85},
      {"XS", 4.85},
      {"SCH 160", 6.35},
      {"XXS", 9.70}}},
    {"1-1/2",
     48.3,
     {{"SCH 40", 3.68}, {"STD", 3.68}, {"SCH 80", 5.08}, {"XS", 5.08}, {"SCH 160", 7.14}}},
    {"2",
     60.3,
     {{"SCH 40", 3.91},
      {"STD", 3.91},
      {"SCH 80", 5.54},
      {"XS", 5.54},
      {"SCH 160", 8.74},
      {"XXS", 11.07}}},
    {"2-1/2",
     73.0,
     {{"SCH 40", 5.16},
      {"STD", 5.16},
      {"SCH 80", 7.01},
      {"XS", 7.01},
      {"SCH 160", 9.53},
      {"XXS", 14.02}}},
    {"3",
     88.9,
     {{"SCH 40", 5.49},
      {"STD", 5.49},
      {"SCH 80", 7.62},
      {"XS", 7.62},
      {"SCH 160", 11.13},
      {"XXS", 15.24}}},
    {"3-1/2", 101.6, {{"SCH 40", 5.74}, {"STD", 5.74}, {"SCH 80", 8.08}, {"XS", 8.08}}},
    {"4",
     114.3,
     {{"SCH 40", 6.02},
      {"STD", 6.02},
      {"SCH 80", 8.56},
      {"XS", 8.56},
      {"SCH 120", 11.13},
      {"SCH 160", 13.49},
      {"XXS", 17.12}}},
    {"5",
     141.3,
     {{"SCH 40", 6.55},
      {"STD", 6.55},
      {"SCH 80", 9.53},
      {"XS", 9.53},
      {"SCH 120", 12.70},
      {"SCH 160", 15.88},
      {"XXS", 19.05}}},
    {"6",
     168.3,
     {{"SCH 40", 7.11},
      {"STD", 7.11},
      {"SCH 80", 10.97},
      {"XS", 10.97},
      {"SCH 120", 14.27},
      {"SCH 160", 18.26},
      {"XXS", 21.95}}},
    {"8",
     219.1,
     {{"SCH 20", 6.35},
      {"SCH 30", 7.04},
      {"SCH 40", 8.18},
      {"STD", 8.18},
      {"SCH 60", 10.31},
      {"SCH 80", 12.70},
      {"XS", 12.70},
      {"SCH 100", 15.09},
      {"SCH 120", 18.26},
      {"SCH 140", 20.62},
      {"XXS", 22.23},
      {"SCH 160", 23.01}}},
    {"10",
     273.0,
     {{"SCH 20", 6.35},
      {"SCH 30", 7.80},
      {"SCH 40", 9.27},
      {"STD", 9.27},
      {"SCH 60", 12.70},
      {"XS", 12.70},
      {"SCH 80", 15.09},
      {"SCH 100", 18.26},
      {"SCH 120", 21.44},
      {"SCH 140", 25.40},
      {"SCH 160", 28.58}}},
    {"12",
     323.8,
     {{"SCH 20", 6.35},
      {"SCH 30", 8.38},
      {"STD", 9.53},
      {"SCH 40", 10.31},
      {"XS", 12.70},
      {"SCH 60", 14.27},
      {"SCH 80", 17.48},
      {"SCH 100", 21.44},
      {"SCH 120", 25.40},
      {"SCH 140", 28.58},
      {"SCH 160", 33.32}}},
    {"14",
     355.6,
     {{"SCH 10", 6.35},
      {"SCH 20", 7.92},
      {"SCH 30", 9.53},
      {"STD", 9.53},
      {"SCH 40", 11.13},
      {"XS", 12.70},
      {"SCH 60", 15.09},
      {"SCH 80", 19.05},
      {"SCH 100", 23.83},
      {"SCH 120", 27.79},
      {"SCH 140", 31.75},
      {"SCH 160", 35.71}}},
    {"16",
     406.4,
     {{"SCH 10", 6.35},
      {"SCH 20", 7.92},
      {"SCH 30", 9.53},
      {"STD", 9.53},
      {"SCH 40", 12.70},
      {"XS", 12.70},
      {"SCH 60", 16.66},
      {"SCH 80", 21.44},
      {"SCH 100", 26.19},
      {"SCH 120", 30.96},
      {"SCH 140", 36.53},
      {"SCH 160", 40.49}}},
    {"18",
     457.0,
     {{"SCH 10", 6.35},
      {"SCH 20", 7.92},
      {"STD", 9.53},
      {"SCH 30", 11.13},
      {"XS", 12.70},
      {"SCH 40", 14.27},
      {"SCH 60", 19.05},
      {"SCH 80", 23.83},
      {"SCH 100", 29.36},
      {"SCH 120", 34.93},
      {"SCH 140", 39.67},
      {"SCH 160", 45.24}}},
    {"20",
     508.0,
     {{"SCH 10", 6.35},
      {"SCH 20", 9.53},
      {"STD", 9.53},
      {"SCH 30", 12.70},
      {"XS", 12.70},
      {"SCH 40", 15.09},
      {"SCH 60", 20.62},
      {"SCH 80", 26.19},
      {"SCH 100", 32.54},
      {"SCH 120", 38.10},
      {"SCH 140", 44.45},
      {"SCH 160", 50.01}}},
    {"22", 559.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"24",
     610.0,
     {{"SCH 10", 6.35},
      {"SCH 20", 9.53},
      {"STD", 9.53},
      {"XS", 12.70},
      {"SCH 30", 14.27},
      {"SCH 40", 17.48},
      {"SCH 60", 24.61},
      {"SCH 80", 30.96},
      {"SCH 100", 38.89},
      {"SCH 120", 46.02},
      {"SCH 140", 52.37},
      {"SCH 160", 59.54}}},
    {"26", 660.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"28", 711.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"30", 762.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"32", 813.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"34", 864.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"36", 914.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"38", 965.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"40", 1016.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"42", 1067.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"44", 1118.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"46", 1168.0, {{"STD", 9.53}, {"XS", 12.70}}},
    {"48", 1219.0, {{"STD", 9.53}, {"XS", 12.70}}},
};

std::vector<TubeSize> all_sizes() {
  std::vector<TubeSize> out;
  for (const auto& nominal : kNominals)
    for (const auto& schedule : nominal.schedules)
      out.push_back({"NPS " + std::string(nominal.nps) + " " + std::string(schedule.name),
                     nominal.outer_diameter, schedule.wall, kAsme});
  add_hollow_sizes(out);
  return out;
}

/// The nominal diameters of ISO 6708 and of ASME B36.10M.
constexpr std::array<std::pair<std::string_view, std::string_view>, 36> kNominalDiameters{
    {{"6", "1/8"},  {"8", "1/4"},    {"10", "3/8"},   {"15", "1/2"},  {"20", "3/4"},
     {"25", "1"},   {"32", "1-1/4"}, {"40", "1-1/2"}, {"50", "2"},    {"65", "2-1/2"},
     {"80", "3"},   {"90", "3-1/2"}, {"100", "4"},    {"125", "5"},   {"150", "6"},
     {"200", "8"},  {"250", "10"},   {"300", "12"},   {"350", "14"},  {"400", "16"},
     {"450", "18"}, {"500", "20"},   {"550", "22"},   {"600", "24"},  {"650", "26"},
     {"700", "28"}, {"750", "30"},   {"800", "32"},   {"850", "34"},  {"900", "36"},
     {"950", "38"}, {"1000", "40"},  {"1050", "42"},  {"1100", "44"}, {"1150", "46"},
     {"1200", "48"}}};

/// "DN100 SCH 40", "DN 100 SCH 40" and "4\" SCH 40" as "NPS 4 SCH 40"; other names as they are.
std::string as_nps(std::string_view name) {
  if (name.starts_with("NPS ") && name.find('"') != std::string_view::npos) name.remove_prefix(4);
  if (const auto quote = name.find('"'); quote != std::string_view::npos && quote > 0)
    return "NPS " + std::string(name.substr(0, quote)) + std::string(name.substr(quote + 1));
  if (!name.starts_with("DN")) return std::string(name);
  const auto from = name.find_first_of("0123456789");
  if (from == std::string_view::npos) return std::string(name);
  const auto digits = name.substr(from);
  const auto end = std::min(digits.find_first_not_of("0123456789"), digits.size());
  const auto* found = std::ranges::find(kNominalDiameters, digits.substr(0, end),
                                        [](const auto& pair) { return pair.first; });
  if (found == kNominalDiameters.end()) return std::string(name);
  return "NPS " + std::string(found->second) + std::string(digits.substr(end));
}

/// A few names, and how many more there are.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 6;
  std::string out;
  for (std::size_t i = 0; i < std::min(kNamed, names.size()); ++i)
    out += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kNamed) out += " and " + std::to_string(names.size() - kNamed) + " more";
  return out;
}

/// Returns the size of this diameter whose wall is nearest; empty if no size has it.
std::string nearest_size(double diameter, double wall) {
  const TubeSize* best = nullptr;
  for (const auto& size : tube_sizes())
    if (same_measure(size.outer_diameter, diameter) &&
        (best == nullptr || std::abs(size.wall - wall) < std::abs(best->wall - wall)))
      best = &size;
  return best == nullptr ? std::string() : best->name;
}

}  // namespace

std::span<const TubeSize> tube_sizes() {
  static const auto kSizes = all_sizes();
  return kSizes;
}

const TubeSize* find_tube_size(std::string_view name) {
  const auto sizes = tube_sizes();
  const auto found = std::ranges::find(sizes, name, &TubeSize::name);
  return found == sizes.end() ? nullptr : &*found;
}

std::string tube_size_hint(std::string_view name) {
  const auto meant = as_nps(name);
  std::vector<std::string> names, of_it;  // of it: sizes that it is the beginning or the end of
  for (const auto& size : tube_sizes()) {
    names.push_back(size.name);
    if (size.name.starts_with(meant + " ") || size.name.starts_with(meant + "x") ||
        size.name.ends_with(" " + meant))
      of_it.push_back(size.name);
  }
  if (of_it.size() > 1) return "did you mean one of " + listed(of_it) + "?";
  const auto measures = measures_in(name);
  if (of_it.empty() && measures.size() == 3) return section_size_hint(name);
  const bool by_measures = of_it.empty() && measures.size() == 2 && !meant.starts_with("NPS");
  const auto near = by_measures     ? nearest_size(measures[0], measures[1])
                    : of_it.empty() ? nearest_name(meant, names)
                                    : of_it.front();
  return near.empty()
             ? "GET /v1/tubes lists the sizes; state any other by outer_diameter_mm and wall_mm"
             : "did you mean " + near + "?";
}

}  // namespace tubecut::api
