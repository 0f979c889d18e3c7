#include "core/bevel/section/section_torch.hpp"

#include <cmath>

#include "core/base/elementary.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel::detail {
namespace {

constexpr double kLowered[] = {0.25, 0.5, 0.75};  // shares of a gap at which rows are lowered
constexpr double kStated[] = {0.125, 0.375, 0.625, 0.875};  // and at which the rest is found too

/// The drop that a place between two rows needs.
struct Need {
  std::size_t row;
  double share, drop, cosine;
};

class Torch {
 public:
  Torch(const SectionSurface& surface, const TableSpec& spec, SectionTable& table)
      : surface_(surface), spec_(spec), table_(table) {}

  void lay(const std::stop_token& stop) {
    const auto n = table_.at.size();
    drop_.assign(n, 0.0);
    if (spec_.kerf > 0.0) {
      for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i)
        drop_[i] = needed_drop(surface_, i, 0.0, spec_.kerf);
      const auto lowered = needs(kLowered, stop);
      for (const auto& need : lowered) lower(need);
      for (const auto& need : lowered) state(need);
      for (const auto& need : needs(kStated, stop)) state(need);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double slope = elementary::tan(table_.b[i]);
      const double foot =
          table_.z_face.empty() ? table_.z_inner[i] : table_.z_face[i] - spec_.root_face * slope;
      table_.torch_inner.push_back(foot - drop_[i]);
      table_.torch_outer.push_back(table_.z_outer[i] - drop_[i]);
    }
  }

 private:
  template <std::size_t N>
  [[nodiscard]] std::vector<Need> needs(const double (&shares)[N], const std::stop_token& stop) {
    std::vector<Need> out;
    for (std::size_t i = 0; i < table_.at.size() && !stop.stop_requested(); ++i) {
      if (!(surface_.width(i) > 0.0)) continue;
      for (const double share : shares) {
        const double slope = surface_.line(i, share).slope(spec_.root_face);
        out.push_back({i, share, needed_drop(surface_, i, share, spec_.kerf),
                       1.0 / elementary::hypot(1.0, slope)});
      }
    }
    return out;
  }

  [[nodiscard]] double laid(const Need& at) const {
    return math::mixed(drop_[at.row], drop_[surface_.next(at.row)], at.share);
  }

  void lower(const Need& at) {
    const double lacks = at.drop - laid(at);
    if (!(lacks > 0.0)) return;
    drop_[at.row] += lacks;
    drop_[surface_.next(at.row)] += lacks;
  }

  void state(const Need& at) {
    auto& out = table_.torch_line;
    const double off = (laid(at) - at.drop) * at.cosine;
    const double s = surface_.line(at.row, at.share).at.s;
    if (-off > out.gouge) {
      out.gouge = -off;
      out.gouge_s = s;
    }
    if (off > out.left) {
      out.left = off;
      out.left_s = s;
    }
  }

  const SectionSurface& surface_;
  const TableSpec& spec_;
  SectionTable& table_;
  std::vector<double> drop_;
};

}  // namespace

std::vector<double> places_where_drop_bends(const SectionSurface& surface, const TableSpec& spec,
                                            const SectionTable& table,
                                            const std::stop_token& stop) {
  std::vector<double> out, drop;
  const auto n = table.at.size();
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i)
    drop.push_back(needed_drop(surface, i, 0.0, spec.kerf));
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i) {
    if (surface.width(i) < kNarrow) continue;
    const double straight = 0.5 * (drop[i] + drop[surface.next(i)]);
    if (std::abs(needed_drop(surface, i, 0.5, spec.kerf) - straight) >
        spec.sampling.tolerance->value)
      out.push_back(surface.line(i, 0.5).at.s);
  }
  return out;
}

void lay_torch(const SectionSurface& surface, const TableSpec& spec, SectionTable& table,
               const std::stop_token& stop) {
  Torch(surface, spec, table).lay(stop);
}

}  // namespace tubecut::bevel::detail
