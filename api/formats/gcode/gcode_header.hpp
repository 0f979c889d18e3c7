#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/formats/gcode/gcode.hpp"
#include "api/formats/gcode/torch_joints.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// One cut as it is printed.
struct TorchCutPlaces {
  std::string name;
  std::vector<TorchPlace> places;  // from the pierce on
  double kerf = 0.0;
  double radius = 0.0;  // of its leads
  bool mark = false;
  bool open = false;                        // a slit
  std::size_t cut_first = 0, cut_last = 0;  // positions between which the torch cuts

  /// Returns the start of the cut.
  [[nodiscard]] const TorchPlace& start() const { return places[cut_first]; }
};

/// How moves between the nodes keep to the lines between them.
struct Straightness {
  double sag = 0.0;  // mm, a bound over all moves
  std::size_t inserted = 0;
};

/// How far the torch goes from one place to another on the outer wall, mm; a swing at a standing
/// tip as an arc of the wall, and never 0.
[[nodiscard]] double way_between(const TorchJob& job, const TorchPlace& from, const TorchPlace& to);

/// The comment lines every program begins with: engine, reference, verdict in plain words.
[[nodiscard]] std::string gcode_job(const Caption& caption);
/// Whether the program lights the torch.
[[nodiscard]] std::string gcode_torch(const FormatOptions& options);
/// Those that end its head.
[[nodiscard]] std::string gcode_hashes(const Caption& caption);

/// Returns the comments that a machinist reads before running a program: piece and verdict, tube,
/// zeros and directions of the axes, tool, feed, time, order, hashes.
[[nodiscard]] std::string program_header(const TorchJob& job,
                                         const std::vector<TorchCutPlaces>& cuts,
                                         const TorchJoints& joints, const Straightness& moves,
                                         const Caption& caption);

/// Returns the comment before a cut's blocks.
[[nodiscard]] std::string cut_title(const TorchCutPlaces& cut, const TorchJoints& joints,
                                    const FormatOptions& options);

}  // namespace tubecut::api
