#pragma once

#include <utility>
#include <vector>

namespace tubecut::api {

/// Positions along a tube on a sheet where long plain pieces of it are left out. Lengths of the
/// tube and of the sheet in mm.
class BrokenScale {
 public:
  using Range = std::pair<double, double>;

  /// `shown`: what must be drawn whole, the first and the last range include the tube's ends.
  /// `scale`: the largest allowed; it is reduced until everything fits into `room`.
  BrokenScale(std::vector<Range> shown, double room, double scale);

  [[nodiscard]] double scale() const { return scale_; }
  /// Position on the sheet, from that of the tube's lower end.
  [[nodiscard]] double x(double z) const;
  /// Returns the positions at which a piece of the tube is left out.
  [[nodiscard]] const std::vector<double>& breaks() const { return breaks_; }

 private:
  struct LinearSegment {
    double from = 0.0, to = 0.0;       // z
    double at = 0.0, shortened = 1.0;  // x of `from`; of a gap, the share that is drawn
  };
  void join(double least);
  void place(double room);

  std::vector<Range> shown_;
  std::vector<LinearSegment> segments_;
  std::vector<double> breaks_;
  double scale_;
};

}  // namespace tubecut::api
