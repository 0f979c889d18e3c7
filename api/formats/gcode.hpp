#pragma once

#include <string>
#include <vector>

#include "api/endpoint.hpp"
#include "core/bevel/table.hpp"

namespace tubecut::api {

/// The torch's way round a cut end: its axis on the outer wall. mm and rad; B > 0: outer edge
/// further into the part.
struct TorchPath {
  double outer_radius = 0.0;
  double wall = 0.0;
  double kerf = 0.0;
  std::vector<double> phi, z, b;  // from the seam to the seam one turn on
};
[[nodiscard]] TorchPath torch_path(const bevel::TableSpec& spec, const bevel::Table& table);

/// A comment line of a program.
[[nodiscard]] std::string gcode_comment(const std::string& text);
/// The comment lines every program begins with: engine, input hash, reference.
[[nodiscard]] std::string gcode_job(const Caption& caption);
/// The lines that light the torch and put it out.
struct TorchWords {
  std::string prepare, on, off;
};
[[nodiscard]] TorchWords torch_words(Dialect dialect);

/// The cut as RS-274 for LinuxCNC: A turns the tube by phi, X (or Z) goes along it, B swings the
/// torch; one G1 a node, in inverse time (G93) so that the torch keeps its speed on the outer wall
/// through every mix of axes. Speed is one parameter at the top.
///
/// With a pivot length the linear axes are the pivot's, and the one square to the tube moves too;
/// without, the control must know the tip. The torch is lit only by the option `torch`.
/// Accuracy  X, Z 1e-5 mm, A 1e-7 deg, B 1e-6 deg.
[[nodiscard]] std::string print_gcode(const TorchPath& path, const Caption& caption);

}  // namespace tubecut::api
