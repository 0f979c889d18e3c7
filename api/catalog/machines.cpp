#include "api/catalog/machines.hpp"

#include <algorithm>
#include <atomic>

#include "api/api.hpp"
#include "api/catalog/posts.hpp"
#include "api/wire/motion_names.hpp"
#include "api/wire/sha256.hpp"

namespace tubecut::api {
namespace {

using motion::AxisUnit;
using motion::BPositive;
using motion::SwingCenter;

constexpr Range kLimit{.min = 0.0, .max = 1e9, .open_min = true};
constexpr Range kAnywhere{.min = -1e6, .max = 1e6};
constexpr Range kArm{.min = 0.0, .max = 10'000.0};

motion::Axis decode_axis(Reader& in) {
  motion::Axis out;
  out.name = in.ascii_text("name", 16);
  out.unit = in.choice("unit", kNames<AxisUnit>);
  const auto which = in.exactly_one({"pulses_per_unit", "pulses_per_turn"});
  if (which == 0) out.pulses_per_unit = in.number("pulses_per_unit", kLimit);
  if (which == 1) out.pulses_per_turn = in.integer("pulses_per_turn", 1, 1'000'000'000);
  out.v_max = in.number("v_max", kLimit);
  out.a_max = in.number("a_max", kLimit);
  out.j_max = in.nullable_number("j_max", kLimit);
  if (!in.is_null("n_max") && in.has("n_max")) out.n_max = in.integer("n_max", 1, 1'000'000'000);
  out.soft_min = in.nullable_number("soft_min", kAnywhere);
  out.soft_max = in.nullable_number("soft_max", kAnywhere);
  return out;
}

motion::Kinematics decode_five_axis_cutter(Reader& in) {
  motion::FiveAxisCutter out;
  out.pivot_length = in.number("pivot_length_mm", kArm);
  out.standoff = in.number("standoff_mm", kArm, 0.0);
  out.z2_share = in.number("z2_share", {.min = 0.0, .max = 1.0}, 0.0);
  return out;
}

motion::Kinematics decode_crawler(Reader& in) {
  motion::Crawler out;
  out.wheel_offset = in.number("wheel_offset_mm", kArm);
  out.swing_center = in.choice("swing_center", kNames<SwingCenter>);
  if (!in.understood("swing_center")) in.silence();
  if (out.swing_center == SwingCenter::pivot) out.pivot_length = in.number("pivot_length_mm", kArm);
  out.standoff_max = in.nullable_number("standoff_max_mm", kArm);
  return out;
}

motion::Kinematics decode_cone_mill(Reader& /*in*/) { return motion::ConeMill{}; }

motion::Kinematics decode_generic(Reader& in) {
  motion::Generic out;
  in.note("maps");
  if (in.has("maps"))
    out.maps = in.array("maps", {.min = 1, .max = 8}, [](Reader& m) {
      motion::LinearMap map;
      map.k_phi = m.number("k_phi", kAnywhere, 0.0);
      map.k_z = m.number("k_z", kAnywhere, 0.0);
      map.k_b = m.number("k_b", kAnywhere, 0.0);
      map.k_0 = m.number("k_0", kAnywhere, 0.0);
      return map;
    });
  return out;
}

motion::Kinematics decode_tube_table(Reader& in) {
  motion::TubeTable out;
  out.pivot_length = in.number("pivot_length_mm", kArm, 0.0);
  out.standoff = in.number("standoff_mm", kArm, 0.0);
  return out;
}

using DecodeKinematics = motion::Kinematics (*)(Reader&);
constexpr std::array kKinds{
    Option<DecodeKinematics>{motion::FiveAxisCutter::kName, decode_five_axis_cutter},
    Option<DecodeKinematics>{motion::Crawler::kName, decode_crawler},
    Option<DecodeKinematics>{motion::ConeMill::kName, decode_cone_mill},
    Option<DecodeKinematics>{motion::Generic::kName, decode_generic},
    Option<DecodeKinematics>{motion::TubeTable::kName, decode_tube_table}};
static_assert(kKinds.size() == std::variant_size_v<motion::Kinematics>, "every kind is read");

void optional_field(std::string_view name, const std::optional<double>& value, Writer& w) {
  if (value)
    w.field(name, *value);
  else
    w.raw(name, "null");
}

void encode_axis(const motion::Axis& axis, Writer& w) {
  w.object([&](Writer& o) {
    o.field("name", axis.name);
    o.field("unit", name_of(axis.unit));
    if (axis.pulses_per_turn > 0)
      o.field("pulses_per_turn", axis.pulses_per_turn);
    else
      o.field("pulses_per_unit", axis.pulses_per_unit);
    o.field("v_max", axis.v_max);
    o.field("a_max", axis.a_max);
    optional_field("j_max", axis.j_max, o);
    optional_field(
        "n_max",
        axis.n_max ? std::optional<double>(static_cast<double>(*axis.n_max)) : std::nullopt, o);
    optional_field("soft_min", axis.soft_min, o);
    optional_field("soft_max", axis.soft_max, o);
  });
}

struct KinematicFields {
  Writer& w;
  void operator()(const motion::FiveAxisCutter& m) const {
    w.field("pivot_length_mm", m.pivot_length);
    w.field("standoff_mm", m.standoff);
    w.field("z2_share", m.z2_share);
  }
  void operator()(const motion::Crawler& m) const {
    w.field("wheel_offset_mm", m.wheel_offset);
    w.field("swing_center", name_of(m.swing_center));
    if (m.swing_center == SwingCenter::pivot) w.field("pivot_length_mm", m.pivot_length);
    optional_field("standoff_max_mm", m.standoff_max, w);
  }
  void operator()(const motion::ConeMill&) const {}
  void operator()(const motion::TubeTable& m) const {
    w.field("pivot_length_mm", m.pivot_length);
    w.field("standoff_mm", m.standoff);
  }
  void operator()(const motion::Generic& m) const {
    if (m.maps.empty()) return;
    w.array("maps", m.maps, [](Writer& each, const motion::LinearMap& map) {
      each.object([&](Writer& o) {
        o.field("k_phi", map.k_phi);
        o.field("k_z", map.k_z);
        o.field("k_b", map.k_b);
        o.field("k_0", map.k_0);
      });
    });
  }
};

/// Every number of it an assumption.
void assume(Process process, ShelfMachine& m) {
  m.process = std::move(process);
  m.process_sha256 = process_sha256(*m.process);
  m.values.push_back({"process/clearance_mm", true, ""});
  for (std::size_t i = 0; i < m.process->rows.size(); ++i)
    for (const auto* name : {"metal_max_mm", "kerf_mm", "speed_mm_min", "pierce_height_mm",
                             "pierce_delay_s", "cut_height_mm", "shortest_lead_mm"})
      m.values.push_back({"process/rows/" + std::to_string(i) + "/" + name, true, ""});
}

Shelf built_in() {
  Shelf out;
  for (auto& entry : motion::catalogue()) {
    auto hash = machine_sha256(entry.machine);
    out.push_back({.machine = std::move(entry.machine),
                   .values = std::move(entry.values),
                   .sha256 = std::move(hash)});
    const auto& kinematics = out.back().machine.kinematics;
    if (std::holds_alternative<motion::FiveAxisCutter>(kinematics))
      assume(assumed_plasma(), out.back());
    if (std::holds_alternative<motion::TubeTable>(kinematics)) assume(assumed_laser(), out.back());
  }
  return out;
}

std::atomic<std::shared_ptr<const Shelf>>& machine_shelf() {
  static std::atomic<std::shared_ptr<const Shelf>> now(std::make_shared<const Shelf>(built_in()));
  return now;
}

const ShelfMachine* find(const Shelf& all, std::string_view name) {
  const auto found = std::ranges::find(
      all, name, [](const ShelfMachine& m) -> std::string_view { return m.machine.name; });
  return found == all.end() ? nullptr : &*found;
}

/// Reads `machine_sha256` and compares it with the request's machine.
void read_pin(Reader& in, const std::string& sha256) {
  const auto pin = in.optional_text("machine_sha256", 64);
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (pin && (pin->size() != sha256.size() || !std::ranges::all_of(*pin, is_hex)))
    in.issue({.code = ErrorCode::bad_text,
              .pointer = "machine_sha256",
              .hint = "64 hex digits; GET /v1/machines lists them"},
             in.find("machine_sha256"));
  else if (pin && *pin != sha256)
    in.issue({.code = ErrorCode::machine_mismatch,
              .pointer = "machine_sha256",
              .limit = Json{sha256},
              .hint = "limit: the hash of the machine that this replica would take"},
             in.find("machine_sha256"));
}

motion::Machine decode_with_process(Reader& in, std::optional<Process>& process) {
  motion::Machine out;
  if (auto name = in.optional_text("name", 64)) out.name = *name;
  const auto type = in.tag("type", kKinds);
  out.period = in.number("period_us", {.min = 50.0, .max = 1e6}) * 1e-6;
  out.b_positive = in.choice("b_positive", kNames<BPositive>);
  if (type) out.kinematics = (*type)(in);
  out.axes = in.array("axes", {.min = 1, .max = 8}, decode_axis);
  process = in.optional_object("process", decode_process);
  return out;
}

/// Adds the machine of a JSON text; returns an error text, or an empty text.
std::string add_machine(std::string_view json, Shelf& all) {
  const auto body = parse(json);
  if (!body) return body.error().reason + " at byte " + std::to_string(body.error().offset);
  Reader in(*body);
  std::optional<Process> process;
  auto machine = decode_with_process(in, process);
  if (const auto issues = in.finish_root(); !issues.empty())
    return issues.front().pointer + ": " + std::string(info(issues.front().code).meaning);
  if (machine.name.empty()) return "/name: a machine on the machine_shelf needs a name";
  if (find(all, machine.name) != nullptr) return "/name: there is a machine of this name already";
  if (const auto sound = motion::check(machine); !sound)
    return sound.error().issues.front().member + ": " +
           std::string(info(sound.error().code()).meaning);
  auto hash = machine_sha256(machine);
  auto of_process = process ? process_sha256(*process) : "";
  all.push_back({.machine = std::move(machine),
                 .values = {},
                 .sha256 = std::move(hash),
                 .process = std::move(process),
                 .process_sha256 = std::move(of_process)});
  return {};
}

}  // namespace

std::shared_ptr<const Shelf> machines() { return machine_shelf().load(); }

motion::Machine decode_machine(Reader& in) {
  std::optional<Process> process;
  return decode_with_process(in, process);
}

void encode_machine(const motion::Machine& machine, Writer& w) {
  if (!machine.name.empty()) w.field("name", machine.name);
  w.field("type", motion::type_name(machine));
  w.field("period_us", std::round(machine.period * 1e9) / 1e3);
  w.field("b_positive", name_of(machine.b_positive));
  std::visit(KinematicFields{w}, machine.kinematics);
  w.array("axes", machine.axes,
          [](Writer& each, const motion::Axis& axis) { encode_axis(axis, each); });
}

std::string machine_sha256(const motion::Machine& machine) {
  Writer out;
  out.object([&](Writer& w) { encode_machine(machine, w); });
  return sha256(out.take());
}

motion::Machine decode_machine_choice(Reader& in, std::string_view name) {
  if (!in.is<std::string>(name)) {
    auto machine = in.object(name, decode_machine);
    if (in.has("machine_sha256") && in.understood(name)) read_pin(in, machine_sha256(machine));
    in.note("machine_sha256");
    return machine;
  }
  const auto all = machines();
  const auto wanted = in.text(name);
  in.note("machine_sha256");
  if (wanted.empty()) return all->front().machine;  // refused already
  if (const auto* found = find(*all, wanted)) {
    read_pin(in, found->sha256);
    if (!in.has("machine_sha256")) in.put("machine_sha256", Json{found->sha256});
    return found->machine;
  }
  in.issue({.code = ErrorCode::unknown_machine,
            .pointer = std::string(name),
            .limit = Json{one_of(*all, [](const auto& m) { return m.machine.name; })}},
           in.find(name));
  return all->front().machine;
}

std::string machines_page() {
  Writer out;
  out.object([](Writer& w) {
    w.array("machines", *machines(), [](Writer& each, const ShelfMachine& m) {
      each.object([&](Writer& o) {
        o.field("name", m.machine.name);
        o.field("machine_sha256", m.sha256);
        if (m.process) o.field("process_sha256", m.process_sha256);
        o.object("machine", [&](Writer& r) { encode_machine(m.machine, r); });
        if (m.process) o.object("process", [&](Writer& p) { encode_process(*m.process, p); });
        o.array("values", m.values, [](Writer& v, const motion::Provenance& value) {
          v.object([&](Writer& x) {
            x.field("member", value.member);
            x.field("assumption", value.assumption);
            x.field("source", value.source);
          });
        });
      });
    });
  });
  return out.take();
}

void encode_machine_hashes(Writer& w) {
  w.array("machines", *machines(), [](Writer& each, const ShelfMachine& m) {
    each.object([&](Writer& o) {
      o.field("name", m.machine.name);
      o.field("machine_sha256", m.sha256);
      if (m.process) o.field("process_sha256", m.process_sha256);
    });
  });
}

std::string set_machines(std::span<const FileText> texts) {
  auto all = built_in();
  for (const auto& [file, json] : texts)
    if (const auto wrong = add_machine(json, all); !wrong.empty()) return file + ": " + wrong;
  machine_shelf().store(std::make_shared<const Shelf>(std::move(all)));
  return {};
}

std::string configuration_sha256() {
  Writer out;
  out.object([](Writer& w) {
    w.field("version", version());
    w.field("numerics", numerics());
    encode_machine_hashes(w);
    encode_post_hashes(w);
  });
  return sha256(out.take());
}

}  // namespace tubecut::api
