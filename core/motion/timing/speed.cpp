#include "core/motion/timing/speed.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/try.hpp"
#include "core/motion/path/program.hpp"

namespace tubecut::motion {
namespace {

constexpr double kMostSpeed = 1e5;  // mm/s; a faster value is a unit error

Result<void> check_speed(double speed, const std::string& member) {
  if (!std::isfinite(speed)) return fail({.code = ErrorCode::bad_number, .member = member});
  if (speed == 0.0) return fail({ErrorCode::zero_limit, member, speed, {}, "mm/s", {}});
  if (speed < 0.0 || speed > kMostSpeed) {
    return fail({ErrorCode::out_of_range, member, speed, kMostSpeed, "mm/s", {}});
  }
  return {};
}

Result<void> check_table(const SpeedTable& table) {
  if (table.pairs.empty()) {
    return fail({.code = ErrorCode::wrong_count, .member = "motion/speed/table"});
  }
  double before = -1.0;
  for (std::size_t i = 0; i < table.pairs.size(); ++i) {
    const std::string at = "motion/speed/table/" + std::to_string(i);
    const auto& [beam, speed] = table.pairs[i];
    if (!(beam >= 0.0 && beam > before)) {
      return fail({ErrorCode::out_of_range, at, beam, before, "mm", "beams must ascend"});
    }
    if (auto ok = check_speed(speed, at); !ok) return ok;
    before = beam;
  }
  return {};
}

Result<void> check_covered(const SpeedTable& table, const Program& program) {
  const double low = table.pairs.front().first, high = table.pairs.back().first;
  const auto [least, most] = std::ranges::minmax_element(program.beam);
  const bool above = most != program.beam.end() && *most > high;
  if (!above && (least == program.beam.end() || *least >= low)) return {};
  const auto worst = above ? most : least;
  const double phi = program.x[0][static_cast<std::size_t>(worst - program.beam.begin())];
  const double turned = phi - kTwoPi * std::floor(phi / kTwoPi);
  return fail({ErrorCode::speed_table_range, "motion/speed/table", *worst, above ? high : low, "mm",
               "at phi " + brief(turned * kDegPerRad) + " deg"});
}

}  // namespace

Result<SpeedAlong> SpeedAlong::of(const Speed& speed, const Program& program) {
  SpeedAlong out;
  if (const auto* const number = std::get_if<double>(&speed)) {
    TRY(check_speed(*number, "motion/speed"));
    out.number_ = *number;
    return out;
  }
  const auto& table = std::get<SpeedTable>(speed);
  TRY(check_table(table));
  TRY(check_covered(table, program));
  out.pairs_ = table.pairs;
  out.lengths_ = program.lengths();
  out.beam_ = program.beam;
  return out;
}

double SpeedAlong::of_beam(double beam) const {
  const auto after = std::ranges::lower_bound(pairs_, beam, {}, &std::pair<double, double>::first);
  if (after == pairs_.begin()) return pairs_.front().second;
  if (after == pairs_.end()) return pairs_.back().second;
  const auto before = after - 1;
  const double share = (beam - before->first) / (after->first - before->first);
  return before->second + share * (after->second - before->second);
}

double SpeedAlong::at_point(std::size_t i) const {
  return pairs_.empty() ? number_ : of_beam(beam_[i]);
}

double SpeedAlong::extreme(double from, double to, bool least) const {
  if (pairs_.empty()) return number_;
  const auto beam_at = [this](double s) {
    const auto after = std::ranges::upper_bound(lengths_, s);
    if (after == lengths_.begin()) return beam_.front();
    if (after == lengths_.end()) return beam_.back();
    const auto i = static_cast<std::size_t>(after - lengths_.begin());
    const double share = (s - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
    return beam_[i - 1] + share * (beam_[i] - beam_[i - 1]);
  };
  double thin = std::min(beam_at(from), beam_at(to));
  double thick = std::max(beam_at(from), beam_at(to));
  for (auto s = std::ranges::upper_bound(lengths_, from); s != lengths_.end() && *s < to; ++s) {
    const double beam = beam_[static_cast<std::size_t>(s - lengths_.begin())];
    thin = std::min(thin, beam);
    thick = std::max(thick, beam);
  }
  const auto pick = [least](double a, double b) { return least ? std::min(a, b) : std::max(a, b); };
  double found = pick(of_beam(thin), of_beam(thick));
  for (const auto& [beam, speed] : pairs_) {
    if (beam > thin && beam < thick) found = pick(found, speed);
  }
  return found;
}

}  // namespace tubecut::motion
