#include <algorithm>

#include "core/bevel/beam.hpp"
#include "core/bevel/table.hpp"

namespace tubecut::bevel {

BeamCut beam_cut(const TableSpec& spec, const Table& table) {
  BeamCut out{.inner = spec.target.inner_radius(),
              .outer = spec.target.outer_radius,
              .kerf = spec.kerf,
              .turn = kTwoPi,
              .part_to_the_left = true};
  const bool land = !table.z_face.empty();
  if (land) {
    out.from = spec.root_face / spec.target.wall;
    out.land = table.z_inner;
  }
  for (std::size_t i = 0; i < table.phi.size(); ++i) {
    const double phi = table.phi[i], high = table.z_outer[i];
    const double foot =
        land ? high - (high - table.z_face[i]) / (1.0 - out.from) : table.z_inner[i];
    out.finished.push_back({phi, foot, phi, high});
    out.torch.push_back({phi, table.torch_inner[i], phi, table.torch_outer[i]});
  }
  return out;
}

std::vector<Check> verify_torch_line(const TableSpec& spec, const Table& table,
                                     const std::stop_token& stop) {
  constexpr double kGouge = 1e-3;                // mm: what beam_proof promises
  constexpr double kLeft = 5e-3, kShare = 0.02;  // mm, and of what is left
  const auto seen = beam_proof(beam_cut(spec, table), Places::rows, stop);
  const auto& stated = table.torch_line;
  return {{"gouge", std::max(seen.gouge, stated.gouge), kGougeLimit, "mm"},
          {"gouge_stated", std::max(0.0, seen.gouge - stated.gouge), kGouge, "mm"},
          {"left_stated", std::max(0.0, seen.left - stated.left),
           std::max(kLeft, kShare * stated.left), "mm"}};
}

}  // namespace tubecut::bevel
