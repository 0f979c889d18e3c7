#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/joint/cutters/cutter.hpp"
#include "core/joint/node/sheets.hpp"

/// For `divide` only: the phases where its profile may have an event.
namespace tubecut::joint::detail {

inline constexpr double kSamePhase = 1e-11;  // rad; closer candidates are merged

/// Returns the shorter distance around the circle.
[[nodiscard]] double phase_distance(double a, double b);

/// Finds silhouettes, corners and crossings of every cutter and pair. It misses no event, but some
/// results are no events, because another cutter is higher there.
class EventPhases {
 public:
  struct Kink {
    double phi;
    std::size_t cutter;
  };

  /// If cancelled, some are missing.
  EventPhases(std::span<const PreparedCutter> cutters, double rho);

  /// Cutters that are hit somewhere and do not repeat an earlier one.
  [[nodiscard]] const std::vector<std::size_t>& active() const { return active_; }
  /// Ascending, [0, 2 pi), distinct.
  [[nodiscard]] const std::vector<double>& phases() const { return phases_; }
  [[nodiscard]] const std::vector<Kink>& kinks() const { return kinks_; }
  /// Returns a length to which the rounding of this active cutter's z is proportional.
  [[nodiscard]] double size_of(std::size_t i) const { return sizes_[i]; }
  /// Returns how far apart two heights of this active cutter at one event may be, mm.
  [[nodiscard]] double noise_of(std::size_t i) const { return event_noise(sheets_[i], size_of(i)); }
  /// Returns true if its surface has no closed form, so its events are bracketed.
  [[nodiscard]] bool scanned(std::size_t i) const { return sheets_[i].empty(); }
  /// Returns the phase where the highest sheet of a scanned cutter ends at a silhouette of its own
  /// while a lower sheet is met: z jumps from the cutter to itself.
  [[nodiscard]] std::optional<double> hidden_at(std::size_t i);

 private:
  [[nodiscard]] bool repeats_an_earlier(std::size_t i) const;
  void add_own(std::size_t i);
  void add_pair(std::size_t i, std::size_t j);
  void add_scanned();
  void add_cells(std::size_t from, std::size_t to, std::vector<std::size_t> cutters);
  void add_cell(std::size_t k, const std::vector<std::size_t>& cutters);
  void add_in_cell(std::size_t i, std::size_t j, std::size_t k);
  void add_border(std::size_t i, std::size_t j, double inside, double outside);
  [[nodiscard]] std::vector<std::size_t> on_top(std::size_t from, std::size_t to,
                                                const std::vector<std::size_t>& cutters) const;
  [[nodiscard]] std::vector<std::size_t> unlike(std::size_t k,
                                                const std::vector<std::size_t>& cutters);
  void merge();
  [[nodiscard]] double apart(std::size_t i, std::size_t j, double phi) const;
  [[nodiscard]] double scanned_height(std::size_t i, std::size_t k);
  [[nodiscard]] bool same_height(std::size_t i, std::size_t j, std::size_t k);
  [[nodiscard]] std::optional<double> polish(std::size_t i, std::size_t j, double near,
                                             const Generator& line) const;
  [[nodiscard]] bool passed_over(std::size_t i, std::size_t j, const Generator& line) const;
  [[nodiscard]] double apart(std::size_t i, std::size_t j, const Generator& line) const;

  std::span<const PreparedCutter> cutters_;
  double rho_;
  std::vector<std::vector<Sheets>> sheets_;  // for each cutter, its parts
  std::vector<std::size_t> active_;
  std::vector<double> sizes_;                         // of the active ones
  std::vector<Met> met_;                              // of every cutter
  std::map<std::size_t, std::vector<double>> scans_;  // NaN: not computed yet
  std::vector<double> phases_;
  std::vector<Kink> kinks_;
};

}  // namespace tubecut::joint::detail
