#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/joint/solid.hpp"

namespace tubecut::joint {

/// The worst value of one check, relative to its own limit.
class Worst {
 public:
  Worst(std::string name, std::string unit) : check_{std::move(name), 0.0, 0.0, std::move(unit)} {}
  void see(double value, double limit);
  [[nodiscard]] const Check& check() const { return check_; }

 private:
  Check check_;
};

/// Proves the heights and events of a profile by the partners' solids. Next to a silhouette a
/// height keeps half its digits, so two places with the metal of a touch between them are one.
class HeightProof {
 public:
  explicit HeightProof(const std::vector<Solid>& solids) : solids_(solids) {}

  /// States the surface of what is seen next by its largest distance from the target's axis, mm.
  void see_surface(double wide) { wide_ = wide; }

  /// Sees a row: it lies on its partner, at its highest place, and no other partner is above.
  /// `here(event)` is true for events at this row.
  template <class Event, class Here>
  void see_row(const Eigen::Vector3d& at, std::size_t cutter, const std::vector<Event>& events,
               Here here) {
    using Kind = decltype(Event::kind);
    std::vector<std::size_t> joined, lost;  // partners of junctions and of jumps
    for (const auto& event : events)
      if ((event.kind == Kind::junction || event.kind == Kind::jump) && here(event))
        for (const auto k : {event.from, event.to})
          (event.kind == Kind::jump ? lost : joined).push_back(k);
    see_height(at, cutter, joined);
    for (std::size_t k = 0; k < solids_.size(); ++k)
      if (k != cutter && std::ranges::find(lost, k) == lost.end())
        see_other(k, at, size(cutter, at.z()));
  }
  /// Both partners of a junction have one height there.
  void see_junction(const Eigen::Vector3d& at, std::size_t from, std::size_t to);
  /// The line through a place touches the partner that is lost there, or that turns its corner.
  void see_touch(const Eigen::Vector3d& at, std::size_t from, std::size_t to, std::size_t lost);
  /// The place lies on the partner.
  void see_seam(const Eigen::Vector3d& at, std::size_t cutter);

  [[nodiscard]] std::vector<Check> checks() const;

 private:
  void see_height(const Eigen::Vector3d& at, std::size_t cutter,
                  const std::vector<std::size_t>& joined);
  void see_other(std::size_t k, const Eigen::Vector3d& at, double size);
  [[nodiscard]] double size(std::size_t k, double z) const;

  const std::vector<Solid>& solids_;
  double wide_ = 0.0;
  Worst on_cutter_{"on_cutter", "mm"}, none_above_{"none_above", "mm"},
      event_gap_{"event_gap", "mm"}, labels_{"labels", "mm"};
};

}  // namespace tubecut::joint
