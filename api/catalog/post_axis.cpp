#include "api/catalog/post_axis.hpp"

#include <charconv>
#include <cmath>

#include "api/formats/text.hpp"
#include "api/limits.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

constexpr double kTurn = 360.0;  // deg
constexpr std::string_view kLetters = "ABCUVWXYZ";

/// Returns the minimum decimals of a word: 0.01 mm and 0.01 deg, or the same resolution in other
/// units.
int least_decimals(PostUnits units, bool turns, TurnUnit turn) {
  if (turns && turn == TurnUnit::revolution) return 5;
  const bool inch = turns ? turn == TurnUnit::inch_girth : units == PostUnits::inch;
  return inch ? 3 : 2;
}

double turn_scale(TurnUnit unit, double diameter) {
  const double girth = kPi * diameter / kTurn;  // mm a deg
  switch (unit) {
    case TurnUnit::deg:
      return 1.0;
    case TurnUnit::mm_girth:
      return girth;
    case TurnUnit::inch_girth:
      return girth / kMmPerInch;
    case TurnUnit::revolution:
      return 1.0 / kTurn;
  }
  return 1.0;
}

/// A letter that counts lengths in other units than the turn's is a slip.
void check_turn_letter(Reader& in, PostUnits units, const PostAxis& axis) {
  const bool inches = axis.unit == TurnUnit::inch_girth;
  if (!axis.is_girth() || axis.letter < 'U' || inches == (units == PostUnits::inch)) return;
  in.issue({.code = ErrorCode::unsupported_combination,
            .pointer = "unit",
            .limit = Json{inches ? "mm_girth" : "inch_girth"},
            .hint = std::string(1, axis.letter) + " counts lengths in the post's units, " +
                    std::string(name_of(units))},
           in.find("unit"));
}

void decode_turn_unit(Reader& in, PostUnits units, PostAxis& out) {
  const bool straight = in.understood("letter") && out.letter >= 'U';
  const auto girth = units == PostUnits::inch ? TurnUnit::inch_girth : TurnUnit::mm_girth;
  in.note("unit");
  // Of a letter that turns it is deg and not echoed: the document stays as it was sent.
  if (straight || in.has("unit")) out.unit = in.choice("unit", straight ? girth : TurnUnit::deg);
  check_turn_letter(in, units, out);
  in.note("diameter_mm");
  if (in.has("diameter_mm") && !out.is_girth())
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "diameter_mm",
              .hint = "only a turn in mm_girth or inch_girth has a diameter"},
             in.find("diameter_mm"));
  else
    out.diameter = in.optional_number("diameter_mm", kDiameter);
}

PostAxis decode_axis(Reader& in, PostUnits units, PostRole role) {
  const bool turns = role >= PostRole::turn;
  PostAxis out;
  const auto letter = in.ascii_text("letter", 1);
  if (!letter.empty() && kLetters.find(letter) == std::string_view::npos)
    in.issue({.code = ErrorCode::bad_choice,
              .pointer = "letter",
              .limit = Json{std::string(kLetters)},
              .hint = "one of " + std::string(kLetters)},
             in.find("letter"));
  if (!letter.empty()) out.letter = letter.front();
  out.reversed = in.flag("reversed", false);
  out.offset = in.number(turns ? "offset_deg" : "offset_mm", kOffset, 0.0);
  if (role == PostRole::turn) decode_turn_unit(in, units, out);
  out.decimals = in.integer("decimals", least_decimals(units, turns, out.unit), 9);
  if (role == PostRole::turn) out.within_turn = in.flag("within_turn", false);
  if (!turns && units == PostUnits::inch) out.scale = 1.0 / kMmPerInch;
  return out;
}

}  // namespace

PostAxis PostAxis::on_tube(double outer_radius) const {
  auto out = *this;
  out.scale = turn_scale(unit, diameter.value_or(2.0 * outer_radius));
  return out;
}

double PostAxis::written(double value) const {
  const auto text = fixed(((reversed ? -value : value) + offset) * scale, decimals);
  double out = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

double PostAxis::counted(double value) const {
  const double out = (reversed ? -value : value) + offset;
  if (!within_turn) return out * scale;
  const double turned = out - kTurn * std::floor(out / kTurn);
  return fixed(turned * scale, decimals) == fixed(kTurn * scale, decimals) ? 0.0 : turned * scale;
}

std::string PostAxis::word(double value) const {
  return std::string(1, letter) + fixed(counted(value), decimals);
}

std::string PostAxis::zero() const {
  auto out = fixed(offset * scale, decimals);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return letter + out;
}

std::string PostAxis::shown(double value) const {
  constexpr int kShown = 3;  // of mm and deg; coarser units have more digits
  int more = 0;
  for (double s = scale; s < 0.1 && more < 3; s *= 10.0) ++more;
  return std::string(1, letter) + " " + fixed(counted(value), kShown + more);
}

double PostAxis::rounding() const {
  double out = 0.5 / scale;
  for (int k = 0; k < decimals; ++k) out /= 10.0;
  return out;
}

std::array<std::optional<PostAxis>, kPostRoles.size()> decode_post_axes(Reader& in,
                                                                        PostUnits units) {
  std::array<std::optional<PostAxis>, kPostRoles.size()> out;
  std::string taken;
  for (std::size_t role = 0; role < kPostRoles.size(); ++role) {
    const auto as = static_cast<PostRole>(role);
    const auto decode = [&](Reader& r) {
      auto axis = decode_axis(r, units, as);
      if (r.understood("letter") && taken.find(axis.letter) != std::string::npos)
        r.issue({.code = ErrorCode::duplicate_id,
                 .pointer = "letter",
                 .hint = "another axis has this letter"},
                r.find("letter"));
      taken += axis.letter;
      return axis;
    };
    const bool needed = as == PostRole::along || as == PostRole::turn;
    const std::string_view name = kPostRoles[role];
    out[role] = needed ? std::optional(in.object(name, decode)) : in.optional_object(name, decode);
  }
  return out;
}

}  // namespace tubecut::api
