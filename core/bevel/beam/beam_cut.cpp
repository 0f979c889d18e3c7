#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bevel/beam/beam.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::bevel {
namespace {

/// Returns the fraction of all pairs of rows that are within a kerf of each other.
double share_within(double kerf, double radius) { return std::min(1.0, kerf / (kTwoPi * radius)); }

}  // namespace

double kerf_pairs(double rows, double kerf, double radius) {
  return rows * rows * share_within(kerf, radius);
}

std::size_t most_rows(double kerf, double radius) {
  constexpr double kAny = 1e15;
  const double most = std::sqrt(kMostKerfPairs / share_within(kerf, radius));
  return most < kAny ? static_cast<std::size_t>(most) : std::numeric_limits<std::size_t>::max();
}

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
  for (auto* lines : {&out.finished, &out.torch}) lines->resize(table.phi.size());
  for (std::size_t i = 0; i < table.phi.size(); ++i) {
    const double phi = table.phi[i], high = table.z_outer[i];
    const double foot =
        land ? high - (high - table.z_face[i]) / (1.0 - out.from) : table.z_inner[i];
    out.finished[i] = {phi, foot, phi, high};
    out.torch[i] = {phi, table.torch_inner[i], phi, table.torch_outer[i]};
  }
  return out;
}

BeamCut beam_cut(const HoleSpec& spec, const Hole& hole) {
  BeamCut out{
      .inner = spec.chord.inner_radius(), .outer = spec.chord.outer_radius, .kerf = spec.kerf};
  double area = 0.0;  // twice, within the outer edge, in (phi, z)
  for (auto* lines : {&out.finished, &out.torch}) lines->reserve(hole.phi.size());
  for (std::size_t i = 0; i < hole.phi.size(); ++i) {
    const auto j = (i + 1) % hole.phi.size();
    area += hole.phi[i] * hole.z[j] - hole.phi[j] * hole.z[i];
    out.finished.push_back({hole.phi_inner[i], hole.z_inner[i], hole.phi[i], hole.z[i]});
    out.torch.push_back(
        {hole.torch_phi_inner[i], hole.torch_z_inner[i], hole.torch_phi[i], hole.torch_z[i]});
  }
  out.part_to_the_left = area < 0.0;
  return out;
}

BeamProof beam_proof(const BeamCut& cut, SampleDensity density) {
  return beam_found(cut, density).proof;
}

Result<void> check_spared(const BeamCut& cut, const BeamProof& proof) {
  if (!(proof.gouge > kGougeLimit)) return {};
  return fail({.code = ErrorCode::out_of_range,
               .member = "kerf",
               .got = cut.kerf,
               .unit = "mm",
               .hint = "a beam as wide would take " + brief(proof.gouge) +
                       " mm from the finished part, at phi " +
                       brief(math::whole_turn(proof.gouge_phi) * kDegPerRad) +
                       " deg: the wall bends tighter there than the kerf"});
}

std::vector<Check> verify_torch_line(const BeamCut& cut, const BeamProof& stated) {
  constexpr double kGouge = 1e-3;                // mm: the accuracy of beam_proof
  constexpr double kLeft = 5e-3, kShare = 0.02;  // mm, and relative to `left`
  const auto seen = beam_proof(cut, SampleDensity::rows);
  return {{"gouge", worst_of({seen.gouge, stated.gouge}), kGougeLimit, "mm"},
          {"gouge_stated", worst_of({0.0, seen.gouge - stated.gouge}), kGouge, "mm"},
          {"left_stated", worst_of({0.0, seen.left - stated.left}),
           std::max(kLeft, kShare * stated.left), "mm"}};
}

}  // namespace tubecut::bevel
