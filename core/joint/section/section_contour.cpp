#include "core/joint/section/section_contour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/joint/cutters/elbow_leg.hpp"
#include "core/joint/section/outline_events.hpp"

namespace tubecut::joint {
namespace {

using section::Curve;
using section::Station;

constexpr double kNearParallel = 0.08715574274765817;  // sin 5 deg: below it dz grows as 1/sin a
constexpr double kUpright = 1e-7;       // axial part of a normal: the height has half its digits
constexpr double kTie = 1e-12;          // of radius + |z|, rounding of one height
constexpr double kSamePlace = 1e-11;    // of the girth / 2 pi: closer places are one
constexpr double kScanPlaces = 1440.0;  // of a girth
constexpr double kOffSeam = 1e-9;       // of the girth

using Label = std::optional<std::size_t>;

/// Finds the events of one outline.
class Divider {
 public:
  explicit Divider(SectionContour& out)
      : out_(out), curve_(out.curve), met_(out.cutters.size(), false) {
    for (std::size_t i = 0; i < out.cutters.size(); ++i) {
      const bool repeats = std::ranges::any_of(active_, [&](std::size_t j) {
        return detail::same_surface(out.cutters[j], out.cutters[i], curve_.reach());
      });
      if (!repeats) active_.push_back(i);
    }
  }

  Result<void> divide() {
    collect();
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    for (std::size_t k = 0; k < places_.size(); ++k)
      labels_.push_back(label_at(0.5 * (places_[k] + after(k))));
    if (places_.empty()) labels_.push_back(label_at(0.5));
    note_met();
    assemble();
    return {};
  }
  /// Refuses an outline that meets no partner, or not everywhere.
  [[nodiscard]] Result<void> check_closed() const;
  Result<void> check_hidden() {
    for (const auto& [cutter, s] : hidden_) {
      const double off = kOffSeam * curve_.girth();
      if (label_at(s - off) != cutter && label_at(s + off) != cutter) continue;
      return fail({.code = ErrorCode::unsupported_combination,
                   .member = "cutters/" + std::to_string(cutter),
                   .got = s,
                   .limit = "an elbow that does not hide itself",
                   .unit = "mm",
                   .hint = "the elbow's bend hides a lower part of the same elbow from the target "
                           "at this place of the girth"});
    }
    return {};
  }

 private:
  [[nodiscard]] double after(std::size_t k) const {
    return k + 1 < places_.size() ? places_[k + 1] : places_.front() + curve_.girth();
  }
  [[nodiscard]] double turned(double s) const {
    const double out = s - curve_.girth() * std::floor(s / curve_.girth());
    return out < curve_.girth() ? out : 0.0;
  }
  [[nodiscard]] double distance(double a, double b) const {
    const double d = std::abs(a - b);
    return std::min(d, curve_.girth() - d);
  }
  [[nodiscard]] double same_place() const { return kSamePlace * curve_.girth() / kTwoPi; }

  void collect() {
    const detail::OutlineEventSpec spec{.cutters = out_.cutters,
                                        .curve = curve_,
                                        .wide = curve_.reach(),
                                        .scan = curve_.girth() / kScanPlaces};
    std::vector<double> found;
    for (const auto& segment : curve_.segments()) {
      if (stopped()) return;
      auto own = detail::outline_events(spec, segment);
      for (const double s : own.places) found.push_back(turned(s));
      for (const auto& kink : own.kinks) kinks_.push_back({turned(kink.s), kink.cutter});
      for (const auto& one : own.hidden) hidden_.push_back({one.cutter, turned(one.s)});
    }
    places_ = curve_.seams();  // these keep their bits
    std::ranges::sort(found);
    std::vector<double> own;
    for (const double s : found) {
      const auto near = [&](double other) { return distance(s, other) <= same_place(); };
      const bool taken = std::ranges::any_of(curve_.seams(), near) ||
                         (!own.empty() && (near(own.back()) || near(own.front())));
      if (!taken) own.push_back(s);
    }
    places_.insert(places_.end(), own.begin(), own.end());
    std::ranges::sort(places_);
  }

  Label label_at(double s) {
    const auto line = generator_through(curve_.at(s).point);
    Label best;
    double best_z = 0.0;
    for (std::size_t i = 0; i < out_.cutters.size(); ++i) {
      const auto z = upper_sheet(out_.cutters[i], line);
      if (!z) continue;
      met_[i] = true;
      if ((best && !(*z > best_z)) || std::ranges::find(active_, i) == active_.end()) continue;
      best = i;
      best_z = *z;
    }
    return best;
  }

  void note_met() {
    for (std::size_t i = 0; i < met_.size(); ++i)
      if (!met_[i]) out_.missed.push_back(i);
  }

  [[nodiscard]] bool is_kink(double s, std::size_t cutter) const {
    return std::ranges::any_of(kinks_, [&](const auto& kink) {
      return kink.cutter == cutter && distance(kink.s, s) <= same_place();
    });
  }
  [[nodiscard]] bool is_seam(double s) const {
    return std::ranges::find(curve_.seams(), s) != curve_.seams().end();
  }

  [[nodiscard]] SectionEvent event_at(double s, std::size_t from, std::size_t to) const {
    const auto at = curve_.at(s);
    const auto line = generator_through(at.point);
    const auto& cutters = out_.cutters;
    SectionEvent event{.s = s,
                       .z_from = out_.height(from, at),
                       .z_to = out_.height(to, at),
                       .from = from,
                       .to = to};
    if (from == to) {
      event.kind = is_kink(s, from) ? SectionEventKind::kink : SectionEventKind::seam;
      if (event.kind == SectionEventKind::kink)
        event.z_from = event.z_to = silhouette_height(cutters[from], line);
      return event;
    }
    const double wide = curve_.reach();
    const auto noise_of = [&](std::size_t i) {
      return event_noise(sheets(cutters[i], wide), rounding_size(cutters[i], wide));
    };
    const double noise = std::max(noise_of(from), noise_of(to));
    const bool jumps = std::abs(event.z_to - event.z_from) > noise;
    event.kind = jumps ? SectionEventKind::jump : SectionEventKind::junction;
    const bool from_higher = event.z_from > event.z_to;
    if (jumps) {
      // The higher of the two is the one at its silhouette.
      (from_higher ? event.z_from : event.z_to) =
          silhouette_height(cutters[from_higher ? from : to], line);
      return event;
    }
    // Next to a silhouette the steeper curve keeps only half the digits of the common height.
    const auto slope = [&](std::size_t i) {
      const auto hit = out_.hit(i, at);
      const bool upright = std::abs(hit.normal.z()) < kUpright;
      return upright ? std::numeric_limits<double>::infinity() : std::abs(hit.z_dphi);
    };
    if (slope(from) > slope(to))
      event.z_from = event.z_to;
    else
      event.z_to = event.z_from;
    return event;
  }

  void assemble() {
    std::vector<std::pair<double, Label>> starts;  // of stretches
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const Label before = labels_[k > 0 ? k - 1 : labels_.size() - 1];
      const Label next = labels_[k];
      const double s = places_[k];
      if (before == next && !(next && (is_seam(s) || is_kink(s, *next)))) continue;
      starts.emplace_back(s, next);
      if (before && next) out_.events.push_back(event_at(s, *before, *next));
    }
    if (starts.empty()) starts.emplace_back(0.0, labels_.front());
    for (std::size_t k = 0; k < starts.size(); ++k) {
      const auto& [from, label] = starts[k];
      const double to =
          k + 1 < starts.size() ? starts[k + 1].first : starts[0].first + curve_.girth();
      if (label)
        out_.segments.push_back({from, to, *label});
      else
        out_.open.emplace_back(from, to);
    }
  }

  SectionContour& out_;
  const Curve& curve_;
  std::vector<std::size_t> active_;  // no other description of an earlier one
  std::vector<bool> met_;
  std::vector<double> places_;  // ascending, [0, girth)
  std::vector<Label> labels_;   // labels_[k] holds between place k and the next one
  std::vector<detail::OutlineEvents::Kink> kinks_;
  std::vector<detail::OutlineEvents::Hidden> hidden_;
};

Result<void> Divider::check_closed() const {
  if (out_.missed.size() == met_.size())
    return fail({.code = ErrorCode::no_contact,
                 .member = "cutters",
                 .got = 0.0,
                 .limit = 1.0,
                 .hint = "none of " + std::to_string(met_.size()) +
                         " partners is met on the outline with a girth of " +
                         brief(curve_.girth()) + " mm"});
  if (out_.open.empty()) return {};
  return fail({.code = ErrorCode::open_profile,
               .member = "cutters",
               .got = out_.open,
               .limit = "a partner at every place of the girth",
               .unit = "mm",
               .hint = "at these places along the girth, from the middle of face 1, nothing is met "
                       "on the outline with a girth of " +
                       brief(curve_.girth()) + " mm"});
}

/// Every cutter prepared; one that cannot be met from this outline is an error of its own.
Result<std::vector<PreparedCutter>> prepared(std::span<const Cutter> cutters, double wide) {
  std::vector<PreparedCutter> out;
  std::vector<Issue> issues;
  for (std::size_t i = 0; i < cutters.size(); ++i) {
    const auto at = "cutters/" + std::to_string(i);
    auto one = under(at, prepare(cutters[i]));
    if (!one) {
      issues.insert(issues.end(), one.error().issues.begin(), one.error().issues.end());
      continue;
    }
    const auto* elbow = std::get_if<PreparedElbow>(&*one);
    if (const auto sine = elbow != nullptr ? endless_leg(*elbow, wide) : std::nullopt) {
      const auto leg = parallel_axes(
          "", *sine,
          "a straight run of the elbow goes along the kept member and would cut it away without "
          "end; let that run point the other way, or pass clear of the member");
      for (auto issue : leg.value().issues) {
        issue.member = at;
        issues.push_back(std::move(issue));
      }
    }
    out.push_back(*std::move(one));
  }
  TRY(no_issues(std::move(issues)));
  return out;
}

}  // namespace

namespace {

Result<SectionContour> divided(std::span<const Cutter> cutters, const Curve& curve, bool closed) {
  if (cutters.empty()) return fail({.code = ErrorCode::wrong_count, .member = "cutters"});
  SectionContour out{.curve = curve,
                     .cutters = {},
                     .events = {},
                     .segments = {},
                     .open = {},
                     .missed = {},
                     .near_parallel = {},
                     .grazed = {}};
  TRY(out.cutters, prepared(cutters, curve.reach()));
  for (std::size_t i = 0; i < out.cutters.size(); ++i)
    if (sin_inclination(out.cutters[i]) < kNearParallel) out.near_parallel.push_back(i);
  for (const auto& cutter : out.cutters) out.grazed.push_back(detail::grazed_faces(cutter, curve));
  Divider divider(out);
  TRY(divider.divide());
  if (closed) {
    TRY(divider.check_closed());
  }
  TRY(divider.check_hidden());
  return out;
}

}  // namespace

Result<SectionContour> trace(std::span<const Cutter> cutters, const Curve& curve) {
  return divided(cutters, curve, true);
}
Result<SectionContour> trace_met(std::span<const Cutter> cutters, const Curve& curve) {
  return divided(cutters, curve, false);
}

double SectionContour::height(std::size_t cutter, const Station& at) const {
  const auto line = generator_through(at.point);
  return grazes(cutter, at) ? silhouette_height(cutters[cutter], line)
                            : continued_sheet(cutters[cutter], line);
}

Hit SectionContour::hit(std::size_t cutter, const Station& at) const {
  Hit out = section_hit(cutters[cutter], at);
  if (!grazes(cutter, at)) return out;
  const auto height_at = [&](double along) {
    const auto place = curve.at(curve.on_face(at.face, along));
    return silhouette_height(cutters[cutter], generator_through(place.point));
  };
  const double half = 0.5 * curve.half_flat(at.face);
  out.z = height(cutter, at);
  out.normal = {out.normal.x() < 0.0 ? -1.0 : 1.0, 0.0, 0.0};
  out.z_dphi = (height_at(half) - height_at(-half)) / (2.0 * half);
  return out;
}

const SectionSegment& segment_at(const SectionContour& contour, double s) {
  const auto next = std::ranges::upper_bound(contour.segments, s, {}, &SectionSegment::from);
  return next == contour.segments.begin() ? contour.segments.back() : *(next - 1);
}

Contact contact_at(const SectionContour& contour, const Station& at) {
  const auto line = generator_through(at.point);
  const auto own = segment_at(contour, at.s).cutter;
  const Contact held{contour.height(own, at), own};
  const double tie = kTie * (line.radius + std::abs(held.z));
  Contact best = held;
  for (std::size_t i = 0; i < contour.cutters.size(); ++i) {
    if (i == own || !upper_sheet(contour.cutters[i], line)) continue;
    const double z = contour.height(i, at);
    if (z > std::max(best.z, held.z + tie)) best = {z, i};
  }
  return best;
}

}  // namespace tubecut::joint
