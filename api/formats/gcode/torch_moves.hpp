#pragma once

#include <optional>
#include <vector>

namespace tubecut::api {

/// Pose of the torch: its axis meets the outer wall at (phi, z), runs outwards along (1, tan a
/// round the tube, tan b along it). mm, rad.
struct TorchPlace {
  double phi = 0.0, z = 0.0, b = 0.0, a = 0.0;
  bool on_flat = false;  // of a section: the torch keeps the normal of the flat
  /// Of a section whose tube is still: the direction that points up, rad.
  std::optional<double> still = {};
};

/// The wall that is cut, and how far the point that the linear axes carry is behind the tip.
struct TorchReach {
  double outer_radius = 0.0;
  double inner_radius = 0.0;
  double pivot = 0.0;  // mm; 0: the control moves the tip
};

/// Point at which the torch's line leaves the inner wall; nothing if it grazes it. mm, rad.
struct InnerPlace {
  double phi = 0.0, z = 0.0;
};
[[nodiscard]] std::optional<InnerPlace> inner_place(const TorchReach& reach, const TorchPlace& at);

/// Returns the thickness of metal in the beam there, mm; infinite if it grazes the inner wall.
[[nodiscard]] double metal_in_beam(const TorchReach& reach, const TorchPlace& at);

/// How far tip and edges may leave the straight lines from one place to the other, in (phi, z) on
/// each wall, while every axis of the machine goes straight and evenly: mm, along the wall.
///
/// The pivot takes the chord of the arc that it should follow, so the tip leaves its line by less
/// than L max|u''| / 8, u the torch's direction; an edge by that over the cosine at which the torch
/// meets its wall. The inner edge leaves its line too because its z and phi are not linear
/// functions of the angles. All three are bounded by second derivatives over the whole move.
///
/// Accuracy  an upper bound; at most twice the exact value if a = 0, infinite if no bound is known
///           (a torch that grazes the wall).
[[nodiscard]] double sag(const TorchReach& reach, const TorchPlace& from, const TorchPlace& to);

/// Returns the ends of moves from one pose to another, the last of them `to`, so short that each
/// sags by at most `limit`; at their ends, both edges are on their lines.
/// Cost    linear in the moves, about |to - from| sqrt(reach / (8 limit)); at most 2^16.
[[nodiscard]] std::vector<TorchPlace> straight_moves(const TorchReach& reach,
                                                     const TorchPlace& from, const TorchPlace& to,
                                                     double limit);

}  // namespace tubecut::api
