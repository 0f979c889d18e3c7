#include "core/part/net_section.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/angle.hpp"

namespace tubecut::part {
namespace {

constexpr int kPlaces = 9;         // of a row of cut-outs
constexpr double kSameRow = 1e-6;  // mm
constexpr double kFound = 1e-7;    // mm
constexpr double kGolden = 0.618033988749894848;

/// One cut-out's height on the tube.
struct Reach {
  double from, to;
  const cutout::Mould* mould;
  double z;
};

double removed_by(const cutout::Mould& mould, double at) {
  if (mould.cone) return cutout::cone_removed(mould.laying, *mould.cone, at);
  return cutout::removed(mould.laying, mould.chain, at);
}

class Removed {
 public:
  explicit Removed(const cutout::Layout& layout) {
    std::vector<cutout::Bounds> boxes;
    for (const auto& mould : layout.moulds) boxes.push_back(bounds(mould.chain));
    for (const auto& one : layout.instances) {
      const auto& box = boxes[one.mould];
      all_.push_back({one.z + box.least.x(), one.z + box.most.x(), &layout.mould_of(one), one.z});
      tallest_ = std::max(tallest_, box.most.x() - box.least.x());
    }
    std::ranges::sort(all_, {}, &Reach::from);
  }

  [[nodiscard]] const std::vector<Reach>& all() const { return all_; }
  [[nodiscard]] double at(double z) const {
    double sum = 0.0;
    for (auto it = std::ranges::lower_bound(all_, z - tallest_, {}, &Reach::from);
         it != all_.end() && it->from < z; ++it)
      if (it->to > z) sum += removed_by(*it->mould, z - it->z);
    return sum;
  }

 private:
  std::vector<Reach> all_;
  double tallest_ = 0.0;
};

}  // namespace

NetSection least_section(double gross, const cutout::Layout& layout) {
  const Removed removed(layout);
  double best = -1.0, at = 0.0, step = 0.0, before = -1e300;
  for (const auto& one : removed.all()) {
    if (one.from - before < kSameRow) continue;  // a row of equals
    before = one.from;
    for (int i = 1; i <= kPlaces; ++i) {
      const double apart = (one.to - one.from) / (kPlaces + 1), z = one.from + i * apart;
      if (const double here = removed.at(z); here > best) {
        best = here;
        at = z;
        step = apart;
      }
    }
  }
  double low = at - step, high = at + step;
  while (high - low > kFound) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (removed.at(a) > removed.at(b))
      high = b;
    else
      low = a;
  }
  const double middle = 0.5 * (low + high);
  if (const double here = removed.at(middle); here > best) {
    best = here;
    at = middle;
  }
  return {.z = at, .area = gross - best, .share = 1.0 - best / gross};
}

}  // namespace tubecut::part
