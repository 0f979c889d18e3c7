#include "api/suspicion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/catalog/tube_sizes.hpp"
#include "api/stop.hpp"

namespace tubecut::api {
namespace {

constexpr double kMmPerInch = 25.4;
constexpr double kMmPerMetre = 1000.0;
constexpr double kSameSize = 1e-3;     // relative: catalogues round inches to 0.1 mm
constexpr double kSameAngle = 2e-3;    // relative: 1.57 and 1.5708 are 90 deg, as 1.5 is not
constexpr double kRoundAngleDeg = 15;  // people mean multiples of it
constexpr double kExactAngle = 1e-4;   // relative: with as many digits also multiples of
constexpr double kFineAngleDeg = 5;
constexpr double kLastBits = 4e-15;  // rad: of a product by pi / 180
constexpr double kShortest = 0.05;   // of its diameter: a tube shorter than that is a ring
constexpr double kTyped = 0.1;       // mm: lengths are designed in multiples of it
constexpr double kFine = 0.01;  // mm: below kTyped, tolerances and their defaults are typed finer
constexpr double kDesigned = 0.5;  // mm: nearly all of a metric design are multiples of it
constexpr double kRounding = 0.5e-3 * kMmPerInch;      // of inches to three decimals
constexpr std::size_t kMostRound = 20, kMostOdd = 40;  // that are counted
constexpr std::size_t kEnough = 3;  // lengths that differ; by chance one is as near in twenty

/// For people: to the micrometre, or the thousandth of a degree.
double brief(double value) { return std::floor(1e3 * value + 0.5) / 1e3; }

double tenths(double value) { return std::floor(10.0 * value + 0.5) / 10.0; }
double degrees_of(double rad) { return rad * 180.0 / std::numbers::pi; }

bool is_sold(double diameter) {
  return std::ranges::any_of(tube_sizes(), [diameter](const TubeSize& tube) {
    return std::abs(tube.outer_diameter - diameter) <= kSameSize * diameter;
  });
}

/// A wall sold in inches on a tube of this diameter, which in mm would be a foil.
bool is_wall_in_inches(double diameter, double wall) {
  const auto sold = [diameter](double mm) {
    return std::ranges::any_of(tube_sizes(), [&](const TubeSize& tube) {
      return std::abs(tube.outer_diameter - diameter) <= kSameSize * diameter &&
             std::abs(tube.wall - mm) <= kSameSize * mm;
    });
  };
  return sold(wall * kMmPerInch) && !sold(wall);
}

/// Returns whether the size is sold in inches and the same number in mm is not a size. Small tubes
/// of whole millimetres are ordinary, although 14 to 48 inches are sold too, so for those the wall
/// decides.
bool is_size_in_inches(double diameter, const double* wall) {
  if (!is_sold(diameter * kMmPerInch) || is_sold(diameter)) return false;
  return diameter != std::floor(diameter) ||
         (wall != nullptr && is_wall_in_inches(diameter * kMmPerInch, *wall));
}

bool is_near_multiple(double value, double of, double relative) {
  const double nearest = of * std::floor(value / of + 0.5);
  return nearest > 0.0 && std::abs(value - nearest) <= relative * nearest;
}

/// Returns the unit of its last digit, in the fewest digits that read back the same.
double last_digit(double value) {
  const auto text = shown(value);
  const auto e = text.find('e');
  const auto exponent = e == std::string::npos ? 0 : std::stoi(text.substr(e + 1));
  const auto digits = text.substr(0, e);
  const auto point = digits.find('.');
  const auto decimals =
      point == std::string::npos ? 0 : static_cast<int>(digits.size() - point) - 1;
  return std::pow(10.0, exponent - decimals);
}

/// Returns whether the number is an angle in radians as people write it, rounded or cut off at any
/// number of digits: 1.5708 is 90 deg. A computed number has all its digits, so it misses every
/// round angle.
bool is_written_of(double value, double of_deg) {
  const double nearest = of_deg * std::floor(degrees_of(value) / of_deg + 0.5);
  return std::abs(value - nearest * std::numbers::pi / 180.0) <= last_digit(value) + kLastBits;
}

bool is_round_angle_in_radians(double value) {
  const double size = std::abs(value), degrees = degrees_of(size);
  const bool round =
      (is_near_multiple(degrees, kRoundAngleDeg, kSameAngle) &&
       is_written_of(size, kRoundAngleDeg)) ||
      (is_near_multiple(degrees, kFineAngleDeg, kExactAngle) && is_written_of(size, kFineAngleDeg));
  return round && degrees <= 360.0 && size != std::floor(size);
}

/// Returns whether people give this field's angle in radians by mistake; a torch's angles are often
/// as small.
bool is_suspected_angle(std::string_view name) {
  static constexpr std::array<std::string_view, 5> kNames{
      "inclination_deg", "clocking_deg", "bend_deg", "half_angle_deg", "angle_deg"};
  return std::ranges::find(kNames, name) != kNames.end();
}

const double* number(const Json& object, std::string_view name) {
  const auto* member = object.find(name);
  return member == nullptr ? nullptr : member->as<double>();
}

/// Of a tube given by its diameter or by the name of its size.
std::optional<double> diameter_of(const Json& tube) {
  if (const auto* diameter = number(tube, "outer_diameter_mm")) return *diameter;
  const auto* member = tube.find("size");
  const auto* name = member == nullptr ? nullptr : member->as<std::string>();
  const auto* size = name == nullptr ? nullptr : find_tube_size(*name);
  return size == nullptr ? std::nullopt : std::optional(size->outer_diameter);
}

/// Returns the length of a member given by its two ends; negative if it has no ends.
double distance_of_ends(const Json& member) {
  const auto* start = member.find("start_mm");
  const auto* end = member.find("end_mm");
  const auto* a = start == nullptr ? nullptr : start->as<Json::Array>();
  const auto* b = end == nullptr ? nullptr : end->as<Json::Array>();
  if (a == nullptr || b == nullptr || a->size() != b->size()) return -1.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a->size(); ++i) {
    const auto* from = (*a)[i].as<double>();
    const auto* to = (*b)[i].as<double>();
    if (from != nullptr && to != nullptr) sum += (*to - *from) * (*to - *from);
  }
  return std::sqrt(sum);
}

/// Metric lengths written in inches: 300 mm as 11.811. A single one may be chance.
class MetricInInches {
 public:
  /// `given`: it is stated in the request, as no default is.
  void check(double value, const std::string& path, bool given) {
    const double mm = std::abs(value);
    if (is_near(mm, mm < kTyped ? kFine : kTyped, 1e-9)) {
      if (given && mm > 0.0 && is_near(mm, kDesigned, 1e-9)) note(mm, kMostRound, round_);
      return;
    }
    const double meant = mm * kMmPerInch;
    // As written: a length that was computed has digits that no rounded one has.
    if (meant < kDesigned / 2.0 || !is_near(meant, kDesigned, kRounding) ||
        !is_near(meant, kDesigned, kMmPerInch * last_digit(mm) + 1e-9)) {
      ++others_;
      return;
    }
    ++alike_;
    if (different_.empty()) path_ = path, first_ = value;
    // Lengths that differ by typed ones count once, because one odd place of a model moves them
    // all.
    if (std::ranges::none_of(different_,
                             [&](double one) { return is_near(mm - one, kTyped, 1e-9); }))
      note(mm, kMostOdd, different_);
  }

  /// Returns whether the lengths look like inches. A few odd lengths, such as defaults in mm and
  /// computed values, do not count against it; if they are many, one more match is required. So is
  /// one for each coordinate or size of a member that is round in mm, because few of a metric
  /// design are round in inches too.
  [[nodiscard]] bool suspected() const {
    const std::size_t more = kEnough * others_ > alike_ ? 1 : 0;
    return different_.size() >= kEnough + more + round_.size() && others_ <= alike_;
  }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] double first() const { return first_; }
  [[nodiscard]] std::size_t count() const { return alike_; }

 private:
  static bool is_near(double value, double of, double within) {
    return std::abs(value - of * std::floor(value / of + 0.5)) <= within;
  }

  static void note(double mm, std::size_t most, std::vector<double>& known) {
    if (known.size() < most && std::ranges::find(known, mm) == known.end()) known.push_back(mm);
  }

  std::vector<double> different_, round_;
  std::string path_;
  double first_ = 0.0;
  std::size_t alike_ = 0, others_ = 0;
};

bool holds_more(const Json& json) {
  return json.as<Json::Array>() != nullptr || json.as<Json::Object>() != nullptr;
}

class Walk {
 public:
  void request(const Json& json) {
    object(json, {}, false);
    if (found.empty() && lengths_.suspected())
      suspect(lengths_.path(), lengths_.first(), "inches", lengths_.first() * kMmPerInch,
              "mm, and so do " + std::to_string(lengths_.count() - 1) + " more lengths");
  }

  std::vector<Warning> found;

 private:
  Pace pace_;
  MetricInInches lengths_;

  /// `lengths`: the numbers of an array are.
  void object(const Json& json, const std::string& path, bool lengths) {
    if (const auto* array = json.as<Json::Array>()) {
      for (std::size_t i = 0; i < array->size(); ++i) {
        pace_.tick();
        const auto& one = (*array)[i];
        if (holds_more(one)) object(one, path + std::to_string(i) + "/", lengths);
        if (const auto* mm = one.as<double>(); lengths && mm != nullptr)
          lengths_.check(*mm, path.substr(0, path.size() - 1), true);
      }
      return;
    }
    const auto* members = json.as<Json::Object>();
    if (members == nullptr) return;
    ask();
    tube(json, path);
    const bool placed = std::ranges::any_of(*members, [](const Json::Member& one) {
      return one.first.ends_with("_mm") && one.second.as<Json::Array>() != nullptr;
    });
    for (const auto& [name, value] : *members) {
      const auto* of = value.as<double>();
      if (is_suspected_angle(name) && of != nullptr && is_round_angle_in_radians(*of)) {
        suspect(path + name, *of, "rad", tenths(degrees_of(*of)), "deg");
      }
      const bool length = name.ends_with("_mm");
      if (length && of != nullptr) lengths_.check(*of, path + name, placed);
      if (holds_more(value)) object(value, path + name + "/", length);
    }
  }

  void tube(const Json& json, const std::string& path) {
    const auto diameter = diameter_of(json);
    if (!diameter) return;
    const auto* wall = number(json, "wall_mm");
    if (is_size_in_inches(*diameter, wall)) {
      suspect(path + "outer_diameter_mm", *diameter, "inches", *diameter * kMmPerInch, "mm");
    }
    if (wall != nullptr && is_wall_in_inches(*diameter, *wall)) {
      suspect(path + "wall_mm", *wall, "inches", *wall * kMmPerInch, "mm");
    }
    const auto* length = number(json, "length_mm");
    if (length != nullptr && *length > 0.0 && *length < kShortest * *diameter) {
      suspect(path + "length_mm", *length, "metres", *length * kMmPerMetre, "mm");
    }
    const double span = distance_of_ends(json);
    if (span > 0.0 && span < kShortest * *diameter) {
      suspect(path + "end_mm", span, "metres", span * kMmPerMetre, "mm between the ends");
    }
  }

  void suspect(std::string member, double value, std::string_view unit, double meant,
               std::string_view wire_unit) {
    found.push_back({.code = WarningCode::unit_suspicion,
                     .member = std::move(member),
                     .detail = shown(value) + " looks like " + std::string(unit) + ": " +
                               shown(brief(meant)) + " " + std::string(wire_unit)});
  }
};

}  // namespace

std::vector<Warning> unit_suspicions(const Json& request) {
  Walk walk;
  walk.request(request);
  return std::move(walk.found);
}

std::string other_unit_hint(double value, std::string_view unit, double min, double max) {
  if (!(value > 0.0 && std::isfinite(max))) return {};
  const auto within = [&](double meant) { return meant >= min && meant <= max; };
  if (unit == "deg" && is_round_angle_in_radians(value) && within(tenths(degrees_of(value))))
    return "; were it radians: " + shown(tenths(degrees_of(value))) + " deg";
  if (unit == "rad" && within(value * std::numbers::pi / 180.0))
    return "; were it degrees: " + shown(brief(value * std::numbers::pi / 180.0)) + " rad";
  if (unit != "mm" || !(min > 0.0)) return {};
  constexpr std::array<std::pair<double, std::string_view>, 3> kUnits{
      {{kMmPerMetre, "metres"}, {kMmPerInch, "inches"}, {1.0 / kMmPerMetre, "micrometres"}}};
  const auto says = [&](const auto& one) {
    return std::string(one.second) + ": " + shown(brief(value * one.first)) + " mm";
  };
  std::string out;
  for (const auto& one : kUnits) {
    const double meant = value * one.first;
    // the bound of a number that is too small may be in the same wrong unit, such as a wall's by
    // its radius
    if (!(value < min ? meant >= min && meant <= max * one.first : within(meant))) continue;
    if (is_sold(meant)) return "; were it " + says(one);
    out += (out.empty() ? "; were it " : ", or ") + says(one);
  }
  return out;
}

}  // namespace tubecut::api
