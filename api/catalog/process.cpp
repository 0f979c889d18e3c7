#include "api/catalog/process.hpp"

#include <algorithm>
#include <utility>

#include "api/catalog/machines.hpp"
#include "api/wire/sha256.hpp"
#include "api/wire/text_encoding.hpp"

namespace tubecut::api {
namespace {

constexpr Range kMetal{.min = 0.1, .max = 1'000.0};
constexpr Range kKerf{.min = 0.0, .max = 100.0};
constexpr CountRange kRows{.min = 1, .max = 200};

ProcessRow decode_row(Reader& in) {
  ProcessRow out;
  out.material = in.ascii_text("material", 64);
  out.metal = in.number("metal_max_mm", kMetal);
  out.kerf = in.number("kerf_mm", kKerf);
  out.speed = in.number("speed_mm_min", kTorchSpeed);
  out.pierce_height = in.number("pierce_height_mm", kTipHeight);
  out.pierce_delay = in.number("pierce_delay_s", kPierceDelay);
  out.cut_height = in.number("cut_height_mm", kTipHeight);
  out.lead = in.number("shortest_lead_mm", {.min = 0.0, .max = kLeadRadius.max, .open_min = true});
  return out;
}

void refuse_twice(Reader& in, const std::vector<ProcessRow>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (rows[i].material == rows[j].material && rows[i].metal == rows[j].metal)
        return in.issue({.code = ErrorCode::duplicate_id,
                         .pointer = "rows/" + std::to_string(i) + "/metal_max_mm",
                         .got = Json{rows[i].metal},
                         .hint = "another row of this material goes up to this thickness"});
}

std::vector<std::string> materials(const Process& process) {
  std::vector<std::string> out;
  for (const auto& row : process.rows)
    if (std::ranges::find(out, row.material) == out.end()) out.push_back(row.material);
  return out;
}

struct PivotLength {
  std::optional<double> operator()(const motion::FiveAxisCutter& m) const { return m.pivot_length; }
  std::optional<double> operator()(const motion::Crawler& m) const {
    return m.swing_center == motion::SwingCenter::pivot ? std::optional(m.pivot_length)
                                                        : std::nullopt;
  }
  std::optional<double> operator()(const motion::ConeMill& /*m*/) const { return std::nullopt; }
  std::optional<double> operator()(const motion::Generic& /*m*/) const { return std::nullopt; }
  std::optional<double> operator()(const motion::TubeTable& m) const { return m.pivot_length; }
};

void refuse_choice(Reader& in, ErrorCode code, std::string_view name, const std::string& list,
                   const std::string& hint) {
  in.issue({.code = code, .pointer = std::string(name), .limit = Json{list}, .hint = hint + list},
           in.find(name));
}

/// Returns the values that a program takes from this machine for this material; issues if it has no
/// such values.
std::optional<MachineProcess> process_of(Reader& in, const std::string& machine,
                                         const std::optional<std::string>& material) {
  const auto all = machines();
  const auto at = std::ranges::find(
      *all, machine, [](const ShelfMachine& m) -> const std::string& { return m.machine.name; });
  std::vector<std::string> names;
  for (const auto& m : *all)
    if (m.process) names.push_back(m.machine.name);
  if (at == all->end() || !at->process) {
    refuse_choice(in, at == all->end() ? ErrorCode::unknown_machine : ErrorCode::bad_choice,
                  "machine", one_of(names), "machines that have a process table: ");
    return std::nullopt;
  }
  MachineProcess out{.machine = machine,
                     .sha256 = at->process_sha256,
                     .pivot_length = std::visit(PivotLength{}, at->machine.kinematics),
                     .clearance = at->process->clearance};
  std::ranges::copy_if(at->process->rows, std::back_inserter(out.rows),
                       [&](const ProcessRow& row) { return row.material == material; });
  if (!out.rows.empty()) return out;
  if (!material) return std::nullopt;
  refuse_choice(in, ErrorCode::bad_choice, "material", one_of(materials(*at->process)),
                "materials of " + machine + ": ");
  return std::nullopt;
}

}  // namespace

Process decode_process(Reader& in) {
  Process out;
  out.clearance = in.optional_number("clearance_mm", kTipClearance);
  out.rows = in.array("rows", kRows, decode_row);
  if (in.understood("rows")) refuse_twice(in, out.rows);
  return out;
}

void encode_process(const Process& process, Writer& w) {
  if (process.clearance) w.field("clearance_mm", *process.clearance);
  w.array("rows", process.rows, [](Writer& each, const ProcessRow& row) {
    each.object([&](Writer& o) {
      o.field("material", row.material);
      o.field("metal_max_mm", row.metal);
      o.field("kerf_mm", row.kerf);
      o.field("speed_mm_min", row.speed);
      o.field("pierce_height_mm", row.pierce_height);
      o.field("pierce_delay_s", row.pierce_delay);
      o.field("cut_height_mm", row.cut_height);
      o.field("shortest_lead_mm", row.lead);
    });
  });
}

std::string process_sha256(const Process& process) {
  Writer out;
  out.object([&](Writer& w) { encode_process(process, w); });
  return sha256(out.take());
}

namespace {

ProcessRow steel(double metal, double kerf, double speed, double pierce, double delay,
                 double height, double lead) {
  return {"steel", metal, kerf, speed, pierce, delay, height, lead};
}

}  // namespace

Process assumed_laser() {
  // Of the size of a fibre laser's cut chart at 4 kW; to be replaced by the machine's own.
  return {.clearance = 20.0,
          .rows = {steel(2.0, 0.15, 9000.0, 6.0, 0.1, 1.0, 1.0),
                   steel(4.0, 0.25, 4000.0, 6.0, 0.3, 1.0, 1.0),
                   steel(6.0, 0.3, 2500.0, 8.0, 0.6, 1.0, 1.0),
                   steel(8.0, 0.4, 1700.0, 10.0, 1.0, 1.2, 1.5),
                   steel(12.0, 0.5, 1000.0, 10.0, 2.0, 1.2, 2.0)}};
}

Process assumed_plasma() {
  // Of the size of an air plasma's cut chart at 100 A; to be replaced by the torch's own.
  return {.clearance = 50.0,
          .rows = {steel(3.0, 1.5, 4500.0, 3.8, 0.1, 1.5, 3.0),
                   steel(6.0, 1.7, 2500.0, 3.8, 0.3, 1.5, 3.0),
                   steel(10.0, 1.9, 1400.0, 4.0, 0.6, 1.5, 4.0),
                   steel(16.0, 2.2, 800.0, 5.0, 1.0, 2.0, 5.0),
                   steel(25.0, 2.6, 400.0, 6.0, 1.8, 2.0, 6.0)}};
}

std::shared_ptr<const MachineProcess> read_machine_process(Reader& in) {
  const auto machine = in.optional_text("machine"), material = in.optional_text("material");
  if (!machine) return nullptr;
  auto found = process_of(in, *machine, material);
  return found ? std::make_shared<const MachineProcess>(*std::move(found)) : nullptr;
}

}  // namespace tubecut::api
