#include "api/formats/numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "api/formats/text.hpp"
#include "api/wire/field_names.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

constexpr int kMost = 6;            // significant digits that anybody is shown
constexpr int kLeast = 4;           // for units without a fixed number of places
constexpr double kRounding = 1e-9;  // below it, a length or an angle is rounding error

/// Returns the number of decimal places; nothing for a unit without a fixed number.
int places(Unit unit, double size) {
  switch (unit) {
    case Unit::mm:
    case Unit::um:
    case Unit::kg:
    case Unit::mm_s:
      return 2;
    case Unit::deg:
    case Unit::percent:
      return 1;
    case Unit::ms:
    case Unit::mm_min:
      return 0;
    case Unit::s:
      return size >= 100.0 ? 1 : size >= 10.0 ? 2 : 3;
    case Unit::none:
    case Unit::mm2:
      return -1;
  }
  return -1;
}

/// Returns the power of ten of the first digit of `value` rounded to `digits` digits.
int power_of(double value, int digits) {
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1);
  const std::string_view all(text, static_cast<std::size_t>(end.ptr - text));
  const auto exponent = all.substr(all.find('e') + 1);
  int power = 0;
  std::from_chars(exponent.data() + (exponent.front() == '+' ? 1 : 0),
                  exponent.data() + exponent.size(), power);
  return power;
}

/// Returns the value rounded to `digits` significant digits, without an exponent.
std::string significant(double value, int digits) {
  const int behind = digits - 1 - power_of(value, digits);
  if (behind >= 0) return fixed(value, behind);
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1);
  double rounded = 0.0;
  std::from_chars(text, end.ptr, rounded);
  return fixed(rounded, 0);
}

std::string without_tail(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

Unit unit_named(std::string_view field) {
  const auto unit = unit_of(field);
  return unit == "mm" ? Unit::mm : unit == "deg" ? Unit::deg : unit == "s" ? Unit::s : Unit::none;
}

std::string_view sign_of(Unit unit) {
  switch (unit) {
    case Unit::none:
      return "";
    case Unit::mm:
      return "mm";
    case Unit::mm2:
      return "mm²";
    case Unit::deg:
      return "°";
    case Unit::percent:
      return "%";
    case Unit::s:
      return "s";
    case Unit::ms:
      return "ms";
    case Unit::um:
      return "µm";
    case Unit::kg:
      return "kg";
    case Unit::mm_min:
      return "mm/min";
    case Unit::mm_s:
      return "mm/s";
  }
  return "";
}

std::string number(double value, Unit unit) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  if (size < kRounding) return "0";
  const int digits = places(unit, size);
  const bool count = unit == Unit::none && value == std::floor(value) && size < 1e6;
  if (count) return fixed(value, 0);
  if (digits < 0) return size < 1e-6 ? "< 0.001" : without_tail(significant(value, kLeast));
  const int power = power_of(value, kMost);
  if (power >= kMost - digits) return without_tail(significant(value, kMost));
  auto out = without_tail(fixed(value, digits));
  if (out != "0") return out;
  return size < 1e-3 ? "< 0.001" : without_tail(significant(value, 1));
}

std::string measure(double value, Unit unit) {
  const auto sign = sign_of(unit);
  return number(value, unit) + (sign.empty() || unit == Unit::deg ? "" : " ") + std::string(sign);
}

std::string degrees(double radians) { return measure(radians * kDegPerRad, Unit::deg); }

std::string degrees_spelled(std::string text) {
  const auto sign = sign_of(Unit::deg);
  for (auto at = text.find(sign); at != std::string::npos; at = text.find(sign))
    text.replace(at, sign.size(), " deg");
  return text;
}

}  // namespace tubecut::api
