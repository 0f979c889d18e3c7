#pragma once

#include <vector>

#include "core/plate/plate.hpp"

/// Plates of a frame. A joint of a member with a plate is set_on, set_in or through: set on, the
/// end is cut at the face that looks at the rest of the member; set in, the member passes through
/// that face to the depth (empty: the thickness); through, its end is not cut.
///
/// Errors  those of plate::make (plates/k/..., joints/i), ambiguous_connection (joints/i: which end,
///         or which face?), no_contact (joints/i: off the plate, or it ends within it),
///         out_of_range (joints/i/depth), joint_contradicts (joints/i: already stated).
namespace tubecut::frame {

/// A tube on a plate: its outline on the face that it is set on, in the plate's x and y.
struct Stood {
  std::size_t member = 0, joint = 0;
  bool front = true;  // on the face with the normal, else on the opposite one
  cutout::Chain outline;
};

/// A plate with what the joints require of it.
struct FramePlate {
  plate::Plate plate;
  std::vector<plate::Passing> passing;  // tubes that are set in or pass through
  std::vector<std::size_t> joints;      // of each of them
  std::vector<Stood> stood;
};

}  // namespace tubecut::frame
