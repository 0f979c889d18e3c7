#include "api/wire/field_names.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace tubecut::api {
namespace {

// Longest first, so that "_deg_per_mm2" is not read as "_mm2".
constexpr std::string_view kUnits[] = {
    "mm3_s",  "deg_per_mm2", "deg_per_mm", "rad_per_mm", "rev_min", "per_hour", "mm_s3", "mm_s2",
    "mm_min", "pulses",      "mm_s",       "m_min",      "mm3",     "mm2",      "deg",   "rad",
    "ms",     "us",          "um",         "kg",         "mm",      "s"};

/// Names that other programs give a field, and its name here; without units.
constexpr std::pair<std::string_view, std::string_view> kOtherWords[] = {
    {"od", "outer_diameter"}, {"dia", "outer_diameter"},  {"outside_diameter", "outer_diameter"},
    {"thickness", "wall"},    {"wall_thickness", "wall"}, {"wt", "wall"},
    {"angle", "inclination"}, {"eccentricity", "offset"}, {"root_gap", "gap"},
    {"bend_angle", "bend"},
};

std::string_view without_unit(std::string_view field) {
  const auto unit = unit_of(field);
  return unit.empty() || unit.size() == field.size()
             ? field
             : field.substr(0, field.size() - unit.size() - 1);
}

/// Levenshtein distance, for names of a few dozen characters.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const auto above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// Returns the number of wrong, missing or extra letters that count as a typo: one in a short word,
/// because more make another word.
std::size_t slips(std::string_view name) { return name.size() < 5 ? 1 : 2; }

std::string in_lower_case(std::string_view text) {
  std::string out(text);
  for (auto& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// Returns the candidate with the fewest changes, at most `farthest`, ignoring case; empty if there
/// is no such candidate.
std::string nearest(std::string_view name, const std::vector<std::string>& known,
                    std::size_t farthest) {
  std::string best;
  std::size_t least = farthest + 1;
  if (name.size() > 64) return best;
  const auto lower = in_lower_case(name);
  for (const auto& candidate : known) {
    const auto d = distance(lower, in_lower_case(candidate));
    if (d < least) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

/// The candidate that has `name` and more words, such as its unit.
std::string begun_by(std::string_view name, const std::vector<std::string>& known) {
  for (const auto& candidate : known)
    if (candidate.size() > name.size() + 1 && candidate.starts_with(name) &&
        candidate[name.size()] == '_')
      return candidate;
  return {};
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  if (auto whole = begun_by(name, known); !whole.empty()) return whole;
  return nearest(name, known, std::max(slips(name), name.size() / 3));
}

std::string slip_of(std::string_view name, const std::vector<std::string>& fields) {
  return nearest(name, fields, slips(name));
}

std::string nearest_field(std::string_view name, const std::vector<std::string>& fields) {
  const auto stem = without_unit(name);
  if (stem.empty()) return {};
  for (const auto& [other, ours] : kOtherWords)
    for (const auto& field : fields)
      if (stem == other && without_unit(field) == ours) return field;
  if (auto whole = begun_by(name, fields); !whole.empty()) return whole;
  if (auto slip = slip_of(name, fields); !slip.empty()) return slip;
  for (const auto& field : fields) {
    const auto ours = without_unit(field);
    if (ours.size() > stem.size() + 1 && ours.ends_with(stem) &&
        ours[ours.size() - stem.size() - 1] == '_')
      return field;
  }
  return nearest_name(name, fields);
}

std::string_view unit_of(std::string_view field) {
  for (const auto unit : kUnits)
    if (field == unit || (field.size() > unit.size() && field.ends_with(unit) &&
                          field[field.size() - unit.size() - 1] == '_'))
      return unit;
  return {};
}

}  // namespace tubecut::api
