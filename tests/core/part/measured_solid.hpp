#pragma once

// A finished part as triangles, and an operator's measurements on it. It knows a part's edges as
// lists of points and nothing of how core measures them.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace tubecut::testing {

using Point = Eigen::Vector3d;
using Triangle = std::array<Point, 3>;

/// One edge as given: phi in rad ascending in [0, 2 pi), straight between on the developed surface.
struct GivenEdge {
  std::vector<double> phi, z;
};

struct GivenPart {
  double outer = 0.0, inner = 0.0;  // radii
  GivenEdge start_outer, start_inner, finish_outer, finish_inner;
};

class MeasuredSolid {
 public:
  explicit MeasuredSolid(const GivenPart& part) : part_(part) {
    rim(part.start_outer, part.outer, start_outer_);
    rim(part.start_inner, part.inner, start_inner_);
    rim(part.finish_outer, part.outer, finish_outer_);
    rim(part.finish_inner, part.inner, finish_inner_);
    skin(start_outer_, finish_outer_, outside_);
  }

  /// The dimension of that name; nothing for a name it does not know.
  [[nodiscard]] std::optional<double> measure(const std::string& name) const {
    const auto starts = [&](const char* s) { return name.rfind(s, 0) == 0; };
    if (name == "girth") return girth();
    if (name == "wall") return wall();
    if (name == "tip_to_tip")
      return std::max(top(finish_outer_), top(finish_inner_)) -
             std::min(bottom(start_outer_), bottom(start_inner_));
    if (name == "throat_to_throat")
      return std::min(bottom(finish_outer_), bottom(finish_inner_)) -
             std::max(top(start_outer_), top(start_inner_));
    for (const int deg : {0, 90, 180, 270})
      if (name == "length_at_" + std::to_string(deg)) return along(deg * std::numbers::pi / 180.0);
    const bool finish = name.find("finish") != std::string::npos;
    const auto& edge = finish ? finish_outer_ : start_outer_;
    const auto& far = extreme(edge, finish);
    const auto& near = extreme(edge, !finish);
    if (name.ends_with("_long_girth")) return around(edge, far);
    if (name.ends_with("_crown_chord")) return (far - near).norm();
    if (name.ends_with("_overhang")) return overhang(finish);
    if (starts("length_at_")) return along(angle(name.ends_with("_long") ? far : near));
    return std::nullopt;
  }
  /// Other places of equal height: the tape may find either long point.
  [[nodiscard]] std::vector<double> long_girths(bool finish) const {
    const auto& edge = finish ? finish_outer_ : start_outer_;
    const double best = extreme(edge, finish).z();
    std::vector<double> out;
    for (std::size_t i = 0; i < edge.size(); ++i) {
      const double before = edge[(i + edge.size() - 1) % edge.size()].z();
      const double after = edge[(i + 1) % edge.size()].z(), here = edge[i].z();
      const bool stands =
          finish ? here >= before && here >= after : here <= before && here <= after;
      if (stands && std::abs(here - best) < 0.011) out.push_back(around(edge, edge[i]));
    }
    return out;
  }

 private:
  static constexpr int kSteps = 1440;

  static double turned(double phi) {
    const double t = std::fmod(phi, 2 * std::numbers::pi);
    return t < 0 ? t + 2 * std::numbers::pi : t;
  }
  static double angle(const Point& p) { return turned(std::atan2(p.y(), p.x())); }

  /// Points of the edge at its own nodes and every quarter of a degree, in order.
  static void rim(const GivenEdge& e, double radius, std::vector<Point>& out) {
    const double whole = 2 * std::numbers::pi;
    const auto put = [&](double phi, double z) {
      out.emplace_back(radius * std::cos(phi), radius * std::sin(phi), z);
    };
    int k = 0;
    const auto grid = [&](double from, double to, double z_from, double z_to) {
      for (; k < kSteps && whole * k / kSteps < to; ++k) {
        const double phi = whole * k / kSteps;
        if (phi <= from) continue;
        put(phi, z_from + (z_to - z_from) * (phi - from) / (to - from));
      }
    };
    const auto n = e.phi.size();
    // Before the first node: the closing stretch.
    const double back = e.phi[n - 1] - whole;
    for (; k < kSteps && whole * k / kSteps < e.phi[0]; ++k) {
      const double phi = whole * k / kSteps;
      put(phi, e.z[n - 1] + (e.z[0] - e.z[n - 1]) * (phi - back) / (e.phi[0] - back));
    }
    for (std::size_t i = 0; i < n; ++i) {
      put(e.phi[i], e.z[i]);
      const double to = i + 1 < n ? e.phi[i + 1] : whole + e.phi[0];
      grid(e.phi[i], std::min(to, whole), e.z[i],
           to <= whole ? e.z[(i + 1) % n]
                       : e.z[i] + (e.z[0] - e.z[i]) * (whole - e.phi[i]) / (to - e.phi[i]));
    }
  }

  /// Triangles between two rims, zipped by angle.
  static void skin(const std::vector<Point>& low, const std::vector<Point>& high,
                   std::vector<Triangle>& out) {
    std::size_t i = 0, j = 0;
    const auto next = [](const std::vector<Point>& rim, std::size_t at) {
      return at + 1 < rim.size() ? angle(rim[at + 1]) : 2 * std::numbers::pi + angle(rim[0]);
    };
    while (i < low.size() || j < high.size()) {
      const bool step_low = j >= high.size() || (i < low.size() && next(low, i) <= next(high, j));
      const Point& a = low[i % low.size()];
      const Point& b = high[j % high.size()];
      if (step_low) {
        out.push_back({a, low[(i + 1) % low.size()], b});
        ++i;
      } else {
        out.push_back({a, high[(j + 1) % high.size()], b});
        ++j;
      }
    }
  }

  static double top(const std::vector<Point>& rim) {
    double out = -std::numeric_limits<double>::infinity();
    for (const auto& p : rim) out = std::max(out, p.z());
    return out;
  }
  static double bottom(const std::vector<Point>& rim) {
    double out = std::numeric_limits<double>::infinity();
    for (const auto& p : rim) out = std::min(out, p.z());
    return out;
  }
  static const Point& extreme(const std::vector<Point>& rim, bool highest) {
    const auto less = [](const Point& a, const Point& b) { return a.z() < b.z(); };
    return highest ? *std::ranges::max_element(rim, less) : *std::ranges::min_element(rim, less);
  }

  /// A tape along the outside in the half plane phi: the cut of that plane with the triangles.
  [[nodiscard]] double along(double phi) const {
    const Point normal(-std::sin(phi), std::cos(phi), 0), side(std::cos(phi), std::sin(phi), 0);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& t : outside_)
      for (int k = 0; k < 3; ++k) {
        const Point &a = t[static_cast<std::size_t>(k)],
                    &b = t[static_cast<std::size_t>((k + 1) % 3)];
        const double da = a.dot(normal), db = b.dot(normal);
        if (a.dot(side) < 0 || b.dot(side) < 0 || (da > 0) == (db > 0)) continue;
        const double z = a.z() + (b.z() - a.z()) * da / (da - db);
        low = std::min(low, z);
        high = std::max(high, z);
      }
    return high - low;
  }

  /// A wrap along the triangles' own vertices, projected square to the axis.
  static double around(const std::vector<Point>& rim, const Point& to) {
    const double end = angle(to);
    std::vector<double> at{0.0};
    for (const auto& p : rim)
      if (angle(p) < end) at.push_back(angle(p));
    at.push_back(end);
    std::ranges::sort(at);
    const double radius = std::hypot(to.x(), to.y());
    double sum = 0;
    for (std::size_t i = 1; i < at.size(); ++i)
      sum += 2 * radius * std::sin((at[i] - at[i - 1]) / 2);
    return sum;
  }
  [[nodiscard]] double girth() const {
    double sum = 0;
    for (std::size_t i = 0; i < start_outer_.size(); ++i) {
      Point step = start_outer_[(i + 1) % start_outer_.size()] - start_outer_[i];
      step.z() = 0;
      sum += step.norm();
    }
    return sum;
  }
  [[nodiscard]] double wall() const {
    return start_outer_[0].head<2>().norm() - start_inner_[0].head<2>().norm();
  }
  /// The widest overhang anywhere: outer and inner edge share their angles.
  [[nodiscard]] double overhang(bool finish) const {
    const auto& o = finish ? finish_outer_ : start_outer_;
    const auto& i = finish ? finish_inner_ : start_inner_;
    double best = 0;
    for (std::size_t k = 0; k < std::min(o.size(), i.size()); ++k) {
      const double ahead = (finish ? -1 : 1) * (o[k].z() - i[k].z());
      if (std::abs(ahead) > std::abs(best)) best = ahead;
    }
    return best;
  }

  GivenPart part_;
  std::vector<Point> start_outer_, start_inner_, finish_outer_, finish_inner_;
  std::vector<Triangle> outside_;
};

}  // namespace tubecut::testing
