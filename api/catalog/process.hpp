#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/wire/reader.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {

// Settings of a program along torch lines, from a request's query or a machine's table.
inline constexpr Range kTorchSpeed{.min = 1.0, .max = 60'000.0};        // mm/min
inline constexpr Range kLeadRadius{.min = 0.0, .max = 1'000.0};         // mm
inline constexpr Range kTipHeight{.min = 0.0, .max = 100.0};            // mm, off the wall
inline constexpr Range kPierceDelay{.min = 0.0, .max = 60.0};           // s
inline constexpr Range kTipClearance{.min = 1.0, .max = 1'000.0};       // mm, over the tube
inline constexpr Range kTabWidth{.min = 0.5, .max = 20.0};              // mm
inline constexpr Range kTorchPivotLength{.min = 0.0, .max = 10'000.0};  // mm

/// Torch settings to cut a material up to a thickness: a row of its cut chart.
struct ProcessRow {
  std::string material;
  double metal = 0.0;  // mm, the most that the beam goes through
  double kerf = 0.0, speed = 0.0;
  double pierce_height = 0.0, pierce_delay = 0.0, cut_height = 0.0;
  double lead = 0.0;  // mm, the shortest radius of a run-in that keeps the pierce off the part
};

/// The process table of a machine.
struct Process {
  std::optional<double> clearance = {};  // mm, of the tip over the tube between two cuts
  std::vector<ProcessRow> rows = {};
};

/// Decodes the member `process` of a machine at `in`.
/// Errors  duplicate_id: two rows of a material with one thickness.
[[nodiscard]] Process decode_process(Reader& in);
void encode_process(const Process& process, Writer& w);
[[nodiscard]] std::string process_sha256(const Process& process);

/// Return the table of a built-in machine, in which every number is an assumption.
[[nodiscard]] Process assumed_plasma();
[[nodiscard]] Process assumed_laser();

/// Values that a program takes from a machine if the request does not set them.
struct MachineProcess {
  std::string machine, sha256;
  std::optional<double> pivot_length = {};  // of a torch that swings about a pivot
  std::optional<double> clearance = {};
  std::vector<ProcessRow> rows = {};  // of one material
};

/// Reads `machine` and `material` of a query; nothing unless both are present.
[[nodiscard]] std::shared_ptr<const MachineProcess> read_machine_process(Reader& in);

}  // namespace tubecut::api
