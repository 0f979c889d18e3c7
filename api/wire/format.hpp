#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/verdict.hpp"
#include "core/torch/tabs.hpp"

namespace tubecut::api {

struct Json;
struct MachineProcess;
struct Post;

/// A file of each part within a bundle, and the part's format that it is in.
struct BundleFile {
  std::string_view name;  // in ?files=
  std::string_view format;
  std::string_view ending;
  bool needs_speed = false;  // and the other options that gcode reads
};
inline constexpr std::string_view kFilesOption = "files";
inline constexpr BundleFile kBundleFiles[] = {
    {"work-order", "svg", ".svg"}, {"nc1", "nc1", ".nc1"}, {"dxf", "dxf", ".dxf"},
    {"step", "step", ".step"},     {"csv", "csv", ".csv"}, {"gcode", "gcode", ".ngc", true}};

/// Paper of a template: one sheet of its full size, or pages.
enum class Paper { sheet, a4, a3, letter, tabloid };

/// Passes of an end with a land in a program: not given, only the bevel's, or both.
enum class Passes { unsaid, bevel, both };

/// Options of a drawing or a machine file in the query. Lengths in mm.
struct FormatOptions {
  bool mirror = false;  // drawn for the print side to lie on the tube
  Paper paper = Paper::sheet;
  bool torch = false;                          // the program lights the torch; else it only moves
  std::vector<std::string> acknowledged = {};  // codes of warnings of a `review` that is cut
  std::shared_ptr<const Post> post = {};       // post that defines the program's syntax
  std::shared_ptr<const MachineProcess> process = {};  // process values for those that the request
                                                       // does not set
  bool axial_z = false;                                // the axis along the tube is Z, not X
  std::optional<double> speed = {};                    // mm/min, of the torch on the outer wall
  std::optional<double> lead = {};     // radius of the arcs that run in and out on the scrap side
  std::optional<double> overcut = {};  // of the cut again, before the run-out
  std::optional<double> start = {};    // phi that each cut begins at, deg
  std::optional<double> pierce_bevel = {};  // largest |B| at the pierce, deg
  std::optional<double> pivot_length = {};  // torch pivot to tip; empty: the control knows the tip
  std::optional<double> pierce_height = {}, cut_height = {};  // of the tip off the wall
  std::optional<double> pierce_delay = {};                    // s
  std::optional<double> clearance = {};  // of the tip over the tube between two cuts
  Passes passes = Passes::unsaid;
  std::optional<torch::Tabs> tabs = {};
  bool marks = false;                     // strokes of a part's marks are in the program
  std::optional<double> mark_speed = {};  // mm/min
  std::optional<double> omega = {};       // of the section of a groove that is drawn, deg
  std::vector<BundleFile> files = {};     // of each part, in a bundle
};

/// Texts that a drawing or a machine file prints in addition to the result.
struct Caption {
  std::vector<std::pair<std::string, std::string>> reference;
  std::vector<std::string> partners = {};         // names of the partners; for a part, the start's
  std::vector<std::string> finish_partners = {};  // of a part
  std::vector<std::string> members = {};          // of a frame, which this part is
  std::string input_sha256;
  std::string result_sha256;
  std::string view;  // ?view=, empty: the format's default
  FormatOptions options = {};
  Verdict verdict = {};           // for the head of every file: verdict_lines
  const Json* request = nullptr;  // with defaults applied
};

/// Thrown by a format that does not support a given option, because no option is ignored without a
/// message.
struct UnfitOption {
  std::string_view name;
  std::string hint;
};

/// One line that names the job on a drawing: engine, input hash, the caller's reference.
[[nodiscard]] std::string job_line(const Caption& caption);

/// One more way to print a result. `print` never sees JSON; core results in, text out.
template <class Spec, class Out>
struct Format {
  std::string_view name;   // ?format=
  std::string_view media;  // Accept
  std::string (*print)(const Spec&, const Out&, const Caption&);
  std::vector<std::string_view> views = {};    // ?view=, the default first
  std::vector<std::string_view> options = {};  // query parameters it reads
  bool needs_speed = false;                    // speed_mm_min has no default
  bool machine = false;                        // a machine works by it as it is
};

struct FormatName {
  std::string_view name;
  std::string_view media;
  std::vector<std::string_view> views = {};
  std::vector<std::string_view> options = {};
  bool needs_speed = false;
  bool machine = false;

  [[nodiscard]] bool is_bundle() const {
    return std::ranges::find(options, kFilesOption) != options.end();
  }
};

}  // namespace tubecut::api
