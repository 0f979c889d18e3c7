#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/groove/joint_geometry.hpp"
#include "core/groove/mill.hpp"
#include "core/groove/mill_position.hpp"
#include "core/groove/optimise.hpp"
#include "core/groove/overcut.hpp"
#include "core/groove/swept.hpp"

namespace tubecut::groove {

struct Optimise {
  Method method = Method::chebyshev;
  Hold hold = Hold::tip;
  Bias bias = Bias::centred;  // of chebyshev
  std::uint64_t seed = 1;     // of annealing
};

struct MillPathSpec {
  GrooveSpec groove;
  Mill mill;
  Setup setup;
  int positions = 90;  // optimised, uniform from omega = 0; 4..20 000
  Optimise optimise;
  GapCheck check;
};

struct MillPath {
  std::vector<MillPosition> positions;
  Swept swept;            // of the machine's motion: linear axes between all emitted positions
  Swept swept_at_optima;  // if only the optima were emitted
  bool qualified = false;
  std::vector<Warning> warnings;
};

inline constexpr int kMinPositions = 4, kMaxPositions = 20000;
inline constexpr int kMaxPoints = 101;  // per ruling; the minimax checks every triple
/// Limits over all positions together: points of their rulings, triples of the points of a ruling,
/// and points for the annealing, which evaluates each 2401 times.
inline constexpr double kMaxSamples = 4e7, kMaxTriples = 1e8, kMaxAnnealedSamples = 2e6;
inline constexpr double kAxisSag =
    1e-3;  // mm, of the tool between emitted positions, at mid interval
inline constexpr double kRootFaceCut = -0.005;   // mm; below it a warning
inline constexpr double kRootFaceReject = -0.5;  // mm; below it the path is not qualified

/// Points of rulings per position, and triples of the points of a ruling.
struct GapWork {
  double samples = 0.0, triples = 0.0;
};
[[nodiscard]] GapWork gap_work(const GapCheck& check);

/// Returns the maximum number of positions to optimise with this method, and to emit.
[[nodiscard]] int most_positions(const GapCheck& check, Method method);
[[nodiscard]] int most_emitted(const GapCheck& check);

/// Computes the cone mill's path around the groove on a C, X, Z, B machine.
///
/// Errors    of `groove` (member "groove/..."), of `check_tool`; sampling, setup, out_of_range,
///           window, contact, z_ineffective, travel, too_many_nodes (more positions for the sag
///           than `most_emitted`), not_converged, cancelled.
/// Accuracy  increments 1e-9 mm and deg; certificate 1e-9 mm; swept figures as `swept`.
/// Cost      0.4 ms per optimised and 0.2 ms per further position, 0.15 s for the swept figures;
///           annealing 15 ms per position.
/// Source    docs/theory/grooves-and-milling.md, sections 6-8.
[[nodiscard]] Result<MillPath> mill_path(const MillPathSpec& spec);

/// Verifies an answer by independent formulas: points in machine space against the cone's apex
/// angle.
///
/// Cost    about 0.1 ms per position.
[[nodiscard]] std::vector<Check> verify(const MillPathSpec& spec, const MillPath& path);

}  // namespace tubecut::groove
