#include "core/joint/events.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/stop.hpp"
#include "core/joint/event_phases.hpp"

namespace tubecut::joint {
namespace {

using detail::phase_distance;

constexpr double kBeside = 1e-9;  // rad

class Divider {
 public:
  Divider(std::span<const PreparedCutter> cutters, double rho)
      : cutters_(cutters), rho_(rho), found_(cutters, rho), phases_(found_.phases()) {}

  Division divide() {
    label();
    if (stopped()) return {};
    auto out = assemble();
    out.hidden = hidden();
    return out;
  }

 private:
  using Label = std::optional<std::size_t>;

  std::optional<Division::Hidden> hidden() {
    for (const auto i : found_.active()) {
      if (stopped()) break;
      if (!found_.scanned(i)) continue;
      if (std::ranges::find(labels_, Label(i)) == labels_.end()) continue;  // never on top
      const auto phi = found_.hidden_at(i);
      if (phi && (label_at(*phi - kBeside) == i || label_at(*phi + kBeside) == i))
        return Division::Hidden{i, *phi};
    }
    return std::nullopt;
  }

  Label label_at(double phi) const {
    const auto line = generator_at(rho_, phi);
    Label best;
    double best_z = 0.0;
    for (const auto i : found_.active()) {
      const auto z = upper_sheet(cutters_[i], line);
      if (!z || (best && !(*z > best_z))) continue;
      best = i;
      best_z = *z;
    }
    return best;
  }

  /// labels_[k] holds between phase k and the next one around the circle.
  void label() {
    if (phases_.empty()) labels_.push_back(label_at(0.5));
    for (std::size_t k = 0; k < phases_.size() && !stopped(); ++k) {
      const double next = k + 1 < phases_.size() ? phases_[k + 1] : phases_[0] + kTwoPi;
      labels_.push_back(label_at(0.5 * (phases_[k] + next)));
    }
  }

  bool is_kink(double phi, std::size_t cutter) const {
    return std::ranges::any_of(found_.kinks(), [&](const auto& kink) {
      return kink.cutter == cutter && phase_distance(kink.phi, phi) <= detail::kSamePhase;
    });
  }

  Event event_at(double phi, std::size_t from, std::size_t to) const {
    const auto line = generator_at(rho_, phi);
    Event event{.phi = phi,
                .z_from = continued_sheet(cutters_[from], line),
                .z_to = continued_sheet(cutters_[to], line),
                .from = from,
                .to = to};
    const double noise = std::max(found_.noise_of(from), found_.noise_of(to));
    const bool jumps = std::abs(event.z_to - event.z_from) > noise;
    event.kind = from == to ? EventKind::kink : jumps ? EventKind::jump : EventKind::junction;
    if (event.kind == EventKind::junction) {
      // Next to a silhouette, the steeper curve keeps only half the digits of the common height.
      const auto slope = [&](std::size_t i) {
        return std::abs(continued_hit(cutters_[i], line).z_dphi);
      };
      (slope(from) > slope(to) ? event.z_from : event.z_to) =
          slope(from) > slope(to) ? event.z_to : event.z_from;
    }
    if (!jumps) return event;
    // The higher of the two is the one at its silhouette.
    const bool lost = event.z_from > event.z_to;
    (lost ? event.z_from : event.z_to) = silhouette_height(cutters_[lost ? from : to], line);
    return event;
  }

  /// Keeps the phases with an event; the labels between them follow.
  Division assemble() const {
    Division out;
    std::vector<std::pair<double, Label>> starts;  // of the intervals
    for (std::size_t k = 0; k < phases_.size(); ++k) {
      const Label before = labels_[k > 0 ? k - 1 : labels_.size() - 1];
      const Label after = labels_[k];
      if (before == after && !(after && is_kink(phases_[k], *after))) continue;
      starts.emplace_back(phases_[k], after);
      if (before && after) out.events.push_back(event_at(phases_[k], *before, *after));
    }
    if (starts.empty()) starts.emplace_back(0.0, labels_.front());
    for (std::size_t k = 0; k < starts.size(); ++k) {
      const double from = starts[k].first;
      const double to = k + 1 < starts.size() ? starts[k + 1].first : starts[0].first + kTwoPi;
      if (const Label& cutter = starts[k].second) {
        out.segments.push_back({from, to, *cutter});
      } else {
        out.open.emplace_back(from * kDegPerRad, to * kDegPerRad);
      }
    }
    return out;
  }

  std::span<const PreparedCutter> cutters_;
  double rho_;
  detail::EventPhases found_;
  const std::vector<double>& phases_;
  std::vector<Label> labels_;  // labels_[k] holds between phase k and the next one
};

}  // namespace

std::optional<Contact> highest(std::span<const PreparedCutter> cutters, const Generator& line) {
  std::optional<Contact> best;
  for (std::size_t i = 0; i < cutters.size(); ++i) {
    const auto z = upper_sheet(cutters[i], line);
    if (z && (!best || *z > best->z)) best = Contact{*z, i};
  }
  return best;
}

Division divide(std::span<const PreparedCutter> cutters, double rho) {
  return Divider(cutters, rho).divide();
}

}  // namespace tubecut::joint
