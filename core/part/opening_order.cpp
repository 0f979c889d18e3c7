#include "core/part/opening_order.hpp"

#include <algorithm>
#include <utility>

#include "core/math/rotation.hpp"

namespace tubecut::part {
namespace {

constexpr double kOneRow = 0.5;  // mm

std::pair<double, double> span_of(const std::vector<double>& a, const std::vector<double>& b) {
  const auto x = std::ranges::minmax(a);
  const auto y = std::ranges::minmax(b);
  return {std::min(x.min, y.min), std::max(x.max, y.max)};
}

/// Phase of the middle of a cut-out.
double middle(const cutout::Layout& layout, const cutout::Instance& one) {
  const auto phi = std::ranges::minmax(layout.mould_of(one).rows.phi);
  return math::whole_turn(one.phi + 0.5 * (phi.min + phi.max));
}

/// Orders a row the way phi grows, from the one nearest to `from` on; returns where it ends.
double go_round(const std::vector<double>& middles, std::vector<Step>::iterator first,
                std::vector<Step>::iterator last, double from) {
  const auto way = [&](const Step& step) { return math::whole_turn(middles[step.index] - from); };
  std::stable_sort(first, last, [&](const Step& a, const Step& b) { return way(a) < way(b); });
  const auto nearest = std::min_element(first, last, [&](const Step& a, const Step& b) {
    return std::min(way(a), kTwoPi - way(a)) < std::min(way(b), kTwoPi - way(b));
  });
  std::rotate(first, nearest, last);
  return middles[std::prev(last)->index];
}

/// Orders openings after adding the cut-outs to the holes among them. A cone follows its circle,
/// because its beam needs the hole to pass into.
std::vector<Step> ordered(std::vector<Step> out, const cutout::Layout& layout) {
  std::vector<std::pair<double, double>> spans;
  for (const auto& mould : layout.moulds)
    spans.push_back(span_of(mould.rows.torch_z, mould.rows.torch_z_inner));
  const auto step = [&](std::size_t i) {
    const auto& one = layout.instances[i];
    const auto& span = spans[one.mould];
    return Step{Step::What::cutout, i, one.z + span.first, one.z + span.second};
  };
  std::vector<double> middles;
  for (std::size_t i = 0; i < layout.instances.size(); ++i) {
    const auto& one = layout.instances[i];
    middles.push_back(middle(layout, one));
    if (!layout.mould_of(one).cone) out.push_back(step(i));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Step& a, const Step& b) { return a.z_to > b.z_to; });
  double at = 0.0;
  for (auto first = out.begin(); first != out.end();) {
    auto last = std::next(first);
    if (first->what == Step::What::cutout) {
      while (last != out.end() && last->what == Step::What::cutout &&
             first->z_to - last->z_to <= kOneRow)
        ++last;
      at = go_round(middles, first, last, at);
    }
    first = last;
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (out[k].what != Step::What::cutout || !layout.instances[out[k].index].sunk) continue;
    out.insert(out.begin() + static_cast<std::ptrdiff_t>(k) + 1, step(out[k].index + 1));
  }
  return out;
}

}  // namespace

std::vector<Step> cutout_order(const cutout::Layout& layout) { return ordered({}, layout); }

std::vector<Step> opening_order(const Part& p) {
  std::vector<Step> out;
  for (std::size_t i = 0; i < p.holes.size(); ++i) {
    const auto& h = p.holes[i].hole;
    const auto span = span_of(h.torch_z, h.torch_z_inner);
    out.push_back({Step::What::hole, i, span.first, span.second});
  }
  return ordered(std::move(out), p.cutouts);
}

std::vector<Step> sequence(const Part& p) {
  std::vector<Step> out;
  for (std::size_t i = 0; i < p.marks.size(); ++i)
    out.push_back({Step::What::mark, i, p.marks[i].z_from, p.marks[i].z_to});
  for (const auto& step : opening_order(p)) out.push_back(step);
  for (const bool finish : {true, false}) {
    const auto& t = finish ? p.finish.table : p.start.table;
    const auto span = span_of(t.torch_inner, t.torch_outer);
    out.push_back({finish ? Step::What::finish : Step::What::start, 0, span.first, span.second});
  }
  return out;
}

}  // namespace tubecut::part
