#include "core/groove/optimise.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"

namespace tubecut::groove {
namespace {

constexpr double kLeastZEffect = 0.0871557427476582;  // sin 5 deg
constexpr double kOptimal = 1e-12;                    // mm, or 5e-15 R if that is coarser
constexpr double kAcceptable = 1e-9;                  // mm, if rounding stops the descent

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}
double sign(double x) { return x < 0.0 ? -1.0 : 1.0; }

/// Returns weights with sum lam J = 0, so that no step can change sum lam g.
Eigen::Vector3d multipliers(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                            const Eigen::Vector2d& c) {
  return {cross(b, c), cross(c, a), cross(a, b)};
}

Eigen::Vector3d pick(std::span<const double> values, const std::array<int, 3>& triple) {
  return {values[std::size_t(triple[0])], values[std::size_t(triple[1])],
          values[std::size_t(triple[2])]};
}

/// Returns the step that levels the three residuals of the reference.
Eigen::Vector2d levelling_step(const Eigen::Vector3d& g, std::span<const Eigen::Vector2d> slopes,
                               const LinearMinimax& at, const Eigen::Vector3d& lam) {
  Eigen::Matrix3d system;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d& slope = slopes[std::size_t(at.reference[std::size_t(k)])];
    system.row(k) << slope.x(), slope.y(), -sign(lam[k]) * sign(lam.dot(g));
  }
  const Eigen::Vector3d solution = system.fullPivLu().solve(-g);
  return {solution.x(), solution.y()};
}

template <class Visit>
void every_triple(int n, Visit visit) {
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      for (int k = j + 1; k < n; ++k) visit(std::array<int, 3>{i, j, k});
}

std::vector<double> residuals(const Gap& gap, double bias) {
  std::vector<double> out;
  for (const Contact& c : gap.contacts) out.push_back(c.gap - bias);
  return out;
}

double worst(const Gap& gap, double bias) {
  double out = 0.0;
  for (const Contact& c : gap.contacts) out = std::max(out, std::abs(c.gap - bias));
  return out;
}

/// One position during the descent.
struct Trial {
  Increment by;
  Gap gap;
  double worst = std::numeric_limits<double>::infinity();
};

class Descent {
 public:
  Descent(const Task& task, Gap initial) : task_(task), at_{{}, std::move(initial), 0.0} {}

  /// Runs the sequential linear minimax of max |g - bias| from where the last one ended.
  tl::expected<Optimum, ErrorCode> run(double bias) {
    constexpr int kSteps = 50;
    at_.worst = worst(at_.gap, bias);
    refuge_.reset();
    for (int i = 0; i < kSteps; ++i) {
      if (stopped()) return tl::unexpected(ErrorCode::cancelled);
      const ToolPose pose = moved(task_.start, task_.setup, task_.hold, at_.by);
      const auto slopes = gap_slopes(task_, pose, at_.gap);
      if (!effective(slopes)) return tl::unexpected(ErrorCode::z_ineffective);
      const LinearMinimax linear = linear_minimax(residuals(at_.gap, bias), slopes);
      const bool last = !refuge_ && at_.worst - linear.level <= tolerance();
      if (!step(linear.step, bias, last)) return stuck(bias);
      if (last) return certified(task_, at_.by, bias, evaluations_, at_.gap);
    }
    return tl::unexpected(ErrorCode::not_converged);
  }

 private:
  /// The state to which the search returns if a step that was accepted on trust leads nowhere.
  struct Refuge {
    Trial from;
    Eigen::Vector2d step;
  };

  static bool effective(const std::vector<Eigen::Vector2d>& slopes) {
    return std::any_of(slopes.begin(), slopes.end(),
                       [](const Eigen::Vector2d& s) { return std::abs(s.x()) >= kLeastZEffect; });
  }

  [[nodiscard]] double tolerance() const {
    return std::max(kOptimal, 5e-15 * task_.near.joint->chord_radius);
  }

  Trial evaluate(Increment by, double bias) {
    ++evaluations_;
    Trial out{by, {}, std::numeric_limits<double>::infinity()};
    auto found = gap(task_.near, task_.cone, moved(task_.start, task_.setup, task_.hold, by));
    if (!found) return out;  // outside the window: an infinite gap
    out.gap = std::move(*found);
    out.worst = worst(out.gap, bias);
    return out;
  }

  Trial along(const Trial& from, const Eigen::Vector2d& by, double part, double bias) {
    return evaluate({from.by.dz + part * by.x(), from.by.db + part * by.y()}, bias);
  }

  /// Takes the whole step if it helps, and once also if it does not (a far B axis bends the path,
  /// and the next linear step corrects that sooner than halving does); else returns and halves. The
  /// last step can only polish.
  bool step(const Eigen::Vector2d& by, double bias, bool last) {
    constexpr double kBearable = 2.0;
    Trial next = along(at_, by, 1.0, bias);
    const double to_beat = refuge_ ? refuge_->from.worst : at_.worst + (last ? tolerance() : 0.0);
    if (next.worst < to_beat) {
      refuge_.reset();
      at_ = std::move(next);
      return true;
    }
    if (last) return true;
    if (!refuge_ && next.worst <= kBearable * at_.worst) {
      refuge_ = Refuge{std::exchange(at_, std::move(next)), by};
      return true;
    }
    const Refuge from = refuge_ ? std::move(*refuge_) : Refuge{at_, by};
    refuge_.reset();
    return halved(from, bias);
  }

  bool halved(const Refuge& refuge, double bias) {
    constexpr double kShortest = 0.01;
    for (double part = 0.5; part >= kShortest; part *= 0.5) {
      at_ = along(refuge.from, refuge.step, part, bias);
      if (at_.worst < refuge.from.worst) return true;
    }
    at_ = refuge.from;
    return false;
  }

  tl::expected<Optimum, ErrorCode> stuck(double bias) {
    Optimum out = certified(task_, at_.by, bias, evaluations_, at_.gap);
    if (!(out.certificate <= kAcceptable)) return tl::unexpected(ErrorCode::not_converged);
    return out;
  }

  const Task& task_;
  Trial at_;
  std::optional<Refuge> refuge_;
  int evaluations_ = 1;  // the initial gap
};

}  // namespace

LinearMinimax linear_minimax(std::span<const double> gaps,
                             std::span<const Eigen::Vector2d> slopes) {
  const int n = int(gaps.size());
  const auto weights = [&](const std::array<int, 3>& t) {
    return multipliers(slopes[std::size_t(t[0])], slopes[std::size_t(t[1])],
                       slopes[std::size_t(t[2])]);
  };
  double largest = 0.0;
  every_triple(
      n, [&](const auto& t) { largest = std::max(largest, weights(t).template lpNorm<1>()); });
  LinearMinimax out;
  out.level = -1.0;
  every_triple(n, [&](const auto& t) {
    const Eigen::Vector3d lam = weights(t);
    const double sum = lam.lpNorm<1>();
    if (!(sum > 1e-12 * largest)) return;
    const double level = std::abs(lam.dot(pick(gaps, t))) / sum;
    if (level <= out.level) return;
    out.level = level;
    out.reference = t;
  });
  if (out.level < 0.0) return {};
  out.step = levelling_step(pick(gaps, out.reference), slopes, out, weights(out.reference));
  return out;
}

std::vector<Eigen::Vector2d> gap_slopes(const Task& task, const ToolPose& pose, const Gap& gap) {
  const double sg = task.setup.mount == Mount::end_up ? -1.0 : 1.0;
  const double lever = task.hold == Hold::pivot ? task.setup.pivot_length : 0.0;
  const Eigen::Vector2d centre = pose.tip + lever * pose.axis;
  std::vector<Eigen::Vector2d> out;
  for (const Contact& c : gap.contacts) {
    const double ws = c.point.x() - centre.x(), wz = c.point.z() - centre.y();
    out.emplace_back(-sg * c.gradient.z(), -sg * (c.gradient.x() * wz - c.gradient.z() * ws));
  }
  return out;
}

Optimum certified(const Task& task, Increment by, double bias, int evaluations, Gap gap) {
  const ToolPose pose = moved(task.start, task.setup, task.hold, by);
  const LinearMinimax linear = linear_minimax(residuals(gap, bias), gap_slopes(task, pose, gap));
  Optimum out;
  out.by = by;
  out.certificate = std::max(0.0, worst(gap, bias) - linear.level);
  out.bias = bias;
  out.reference = linear.reference;
  out.evaluations = evaluations;
  out.gap = std::move(gap);
  return out;
}

tl::expected<Optimum, ErrorCode> chebyshev(const Task& task, Bias bias, Gap initial) {
  Descent descent{task, std::move(initial)};
  auto out = descent.run(0.0);
  if (bias == Bias::centred) return out;
  // Lifting everything by G slightly changes the attainable G: aim at the new one until they agree.
  constexpr int kRounds = 8;
  for (int i = 0; out && i < kRounds; ++i) {
    const double aim = worst(out->gap, out->bias);
    if (std::abs(aim - out->bias) <= kOptimal) break;
    out = descent.run(aim);
  }
  return out;
}

tl::expected<Optimum, ErrorCode> annealing(const Task& task, std::mt19937_64& random) {
  constexpr int kLevels = 80, kMoves = 30;
  constexpr double kCooling = 0.93;
  const auto objective = [&task](Increment by) {
    return grid_figures(task.near, task.cone, moved(task.start, task.setup, task.hold, by))
        .objective();
  };
  const auto uniform = [&random] { return double(random() >> 11) * 0x1p-53; };
  double here = objective({}), temperature = here;
  const double start = here;
  Increment at, best;
  double least = here;
  // Moves some times the error that they must remove: in Z directly, in B at the generatrix's far
  // end.
  const double reach = task.hold == Hold::tip ? task.cone.generatrix
                                              : task.cone.generatrix + task.setup.pivot_length;
  for (int level = 0; level < kLevels; ++level, temperature *= kCooling) {
    const double size = 8.0 * std::max(temperature, 0.01 * start);
    for (int move = 0; move < kMoves; ++move) {
      if (stopped()) return tl::unexpected(ErrorCode::cancelled);
      const double dz = size * (2.0 * uniform() - 1.0), db = size / reach * (2.0 * uniform() - 1.0);
      const Increment next{at.dz + dz, at.db + db};
      const double there = objective(next);
      if (!(there <= here || uniform() < elementary::exp((here - there) / temperature))) continue;
      at = next;
      here = there;
      if (here < least) {
        least = here;
        best = at;
      }
    }
  }
  TRY(auto found, gap(task.near, task.cone, moved(task.start, task.setup, task.hold, best)));
  return certified(task, best, 0.0, 1 + kLevels * kMoves, std::move(found));
}

}  // namespace tubecut::groove
