#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <stop_token>
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
  bool needs_speed = false;  // and what else gcode reads
};
inline constexpr std::string_view kFilesOption = "files";
inline constexpr BundleFile kBundleFiles[] = {
    {"work-order", "svg", ".svg"}, {"nc1", "nc1", ".nc1"}, {"dxf", "dxf", ".dxf"},
    {"step", "step", ".step"},     {"csv", "csv", ".csv"}, {"gcode", "gcode", ".ngc", true}};

/// What a template is printed on: one sheet as large as it is, or pages.
enum class Paper { sheet, a4, a3, letter, tabloid };

/// Which passes of an end with a land a program has: nobody says, the bevel's alone, or both.
enum class Passes { unsaid, bevel, both };

/// What the query says of a drawing or a machine file. Lengths in mm.
struct FormatOptions {
  bool mirror = false;  // drawn for the print side to lie on the tube
  Paper paper = Paper::sheet;
  bool torch = false;                          // the program lights the torch; else it only moves
  std::vector<std::string> acknowledged = {};  // codes of warnings of a `review` that is cut
  std::shared_ptr<const Post> post = {};       // whose words a program is written in
  std::shared_ptr<const MachineProcess> process = {};  // what a program says nothing of, takes
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

/// What a drawing or a machine file prints beside the result.
struct Caption {
  std::vector<std::pair<std::string, std::string>> reference;
  std::vector<std::string> partners = {};         // what they are called; of a part, the start's
  std::vector<std::string> finish_partners = {};  // of a part
  std::vector<std::string> members = {};          // of a frame, which this part is
  std::string input_sha256;
  std::string result_sha256;
  std::string view;  // ?view=, empty: the format's default
  FormatOptions options = {};
  Verdict verdict = {};           // stands in the head of every file: verdict_lines
  const Json* request = nullptr;  // as understood
  std::stop_token stop = {};
};

/// Thrown by a format that has no use for an option that was given: nothing is ignored in silence.
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
