#include "api/endpoints/motion/motion_codec.hpp"

#include <cmath>

#include "api/catalog/machines.hpp"
#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/groove_codec.hpp"
#include "api/endpoints/motion/motion_options.hpp"
#include "api/endpoints/motion/part_job.hpp"
#include "api/limits.hpp"
#include "api/wire/common_fields.hpp"
#include "api/wire/motion_names.hpp"
#include "api/wire/tables.hpp"
#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/motion/path/upright.hpp"

namespace tubecut::api {
namespace {

using motion::Scrap;
using motion::Surface;

constexpr CountRange kPoints{.min = 3, .max = static_cast<std::size_t>(limit::nodes_max)};
constexpr Range kUnwrappedDeg{.min = -36'000.0, .max = 36'000.0};
constexpr Range kBevelDeg{.min = -85.0, .max = 85.0};

/// The values of a table's points that determine their sign of B.
struct TorchLines {
  std::vector<double> inner, outer;
};

/// Decodes a bevel table's own points, unchanged: the torch line on the requested surface.
TorchLines decode_table_points(Reader& in, Surface surface, motion::CutPath& out) {
  for (const auto& name : bevel_column_names()) in.note(name);
  out.phi = in.angle_column("phi_deg", kPoints, kUnwrappedDeg);
  out.b = in.angle_column("b_deg", kPoints, kBevelDeg);
  out.beam = in.column("beam_mm", kPoints, kBeam);
  if (in.has("corner")) out.corner = in.flag_column("corner", kPoints);
  TorchLines lines{in.column("torch_inner_mm", kPoints, kOffset),
                   in.column("torch_outer_mm", kPoints, kOffset)};
  out.z = surface == Surface::outer ? lines.outer : lines.inner;
  return lines;
}

/// The sign must be stated: swung the other way, the torch cuts another joint.
std::optional<BSign> decode_b_sign(Reader& in) {
  const auto sign = in.choice("b_sign", kNames<BSign>);
  if (!in.understood("b_sign")) return std::nullopt;
  if (sign == BSign::inward)
    in.issue({.code = ErrorCode::comparison_only,
              .pointer = "b_sign",
              .limit = Json{"outer_edge_into_part|outer_edge_to_plus_z"},
              .hint = "points that count B inward are for comparison with published figures"},
             in.find("b_sign"));
  return sign;
}

/// Checks the sign: `outer_edge_into_part` is towards +z only on the part's side.
void check_b_sign(Reader& in, BSign sign, Scrap scrap) {
  if (sign != BSign::outer_edge_into_part || scrap == Scrap::minus_z) return;
  in.issue({.code = ErrorCode::unsupported_combination,
            .pointer = "b_sign",
            .limit = Json{"outer_edge_to_plus_z"},
            .hint = "into the part is towards +z only where the scrap is at -z"},
           in.find("b_sign"));
}

/// Checks that both walls are passed at heights that differ by wall tan B. Otherwise the points
/// belong to another wall, or count B in reverse.
void check_torch_lines(Reader& in, const motion::CutPath& contour, const TorchLines& lines) {
  constexpr double kApart = 1e-3;  // mm; far above the rounding of printed numbers
  const auto n = std::min({contour.b.size(), lines.inner.size(), lines.outer.size()});
  for (std::size_t i = 0; i < n; ++i) {
    const double apart = lines.outer[i] - lines.inner[i];
    const double swung = contour.wall * elementary::tan(contour.b[i]);
    if (std::abs(apart - swung) <= kApart) continue;
    const bool other_way = std::abs(apart + swung) <= kApart;
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = other_way ? "b_sign" : "wall_mm",
              .got = Json{swung},
              .limit = Json{apart},
              .unit = "mm",
              .hint = "the distance of the torch lines at point " + std::to_string(i) +
                      " shows that " + (other_way ? "B counts in reverse" : "the wall differs")});
    return;
  }
}

motion::CutPath decode_contour(Reader& in) {
  motion::CutPath out;
  out.surface = in.choice("surface", kNames<Surface>);
  out.outer_radius = in.number("outer_diameter_mm", kDiameter) / 2.0;
  const bool sized = in.understood("outer_diameter_mm");
  out.wall = in.number("wall_mm", sized ? wall_of(out.outer_radius) : kWall);
  out.closed = in.flag("closed");
  const auto sign = decode_b_sign(in);
  in.note("scrap");
  if (in.exactly_one({"phi_deg", "points"}) == 1) {
    const auto lines =
        in.object("points", [&](Reader& p) { return decode_table_points(p, out.surface, out); });
    out.scrap = in.choice("scrap", Scrap::minus_z);
    if (sign && sign != BSign::inward && in.understood("scrap")) check_b_sign(in, *sign, out.scrap);
    if (sign && sign != BSign::inward && in.understood("wall_mm"))
      check_torch_lines(in, out, lines);
    return out;
  }
  out.phi = in.angle_column("phi_deg", kPoints, kUnwrappedDeg);
  out.z = in.column("z_mm", kPoints, kOffset);
  out.b = in.angle_column("b_deg", kPoints, kBevelDeg);
  in.note("corner");
  if (in.has("corner")) out.corner = in.flag_column("corner", kPoints);
  in.note("beam_mm");
  if (in.has("beam_mm")) out.beam = in.column("beam_mm", kPoints, kBeam);
  if (in.has("scrap")) out.scrap = in.choice("scrap", kNames<Scrap>);
  if (sign && in.understood("scrap")) check_b_sign(in, *sign, out.scrap);
  return out;
}

motion::AxisColumns decode_axes(Reader& in, const motion::Machine& machine) {
  motion::AxisColumns out;
  if (in.refused()) in.silence();  // its members are the machine's axes
  out.length = in.column("s_mm", kPoints, kOffset);
  for (const auto& axis : machine.axes)
    out.columns.push_back(in.column(axis.name, kPoints, kOffset));
  in.note("corner");
  if (in.has("corner")) out.corner = in.flag_column("corner", kPoints);
  out.closed = in.flag("closed", false);
  return out;
}

/// The torch line of a table on its root surface, a corner at each event that is a node.
motion::CutPath contour_of(const bevel::TableSpec& spec, const bevel::Table& table) {
  const bool outer = spec.root_surface == bevel::RootSurface::outer;
  motion::CutPath out;
  out.phi = table.phi;
  out.z = outer ? table.torch_outer : table.torch_inner;
  out.b = table.b;
  out.beam = table.beam;
  out.outer_radius = spec.target.outer_radius;
  out.wall = spec.target.wall;
  out.surface = outer ? Surface::outer : Surface::inner;
  out.corner = corners(spec, table);
  return motion::without_repeats(std::move(out));
}

/// The torch line of a section's table on its outside, a corner at each event other than a seam.
motion::CutPath contour_of(const section::Section& section, const bevel::SectionTable& table) {
  auto out = motion::around(section);
  for (const auto& at : table.at) out.phi.push_back(at.s / out.outer_radius);
  out.z = table.torch_outer;
  out.b = table.b;
  out.beam = table.beam;
  out.corner = table.corner;
  return motion::without_repeats(std::move(out));
}

/// The mill's emitted positions, closed after one turn of C. A machine counts C on, not modulo a
/// turn.
Result<motion::AxisColumns> columns_of(const groove::MillPathSpec& spec,
                                       const groove::MillPath& path,
                                       const motion::Machine& machine) {
  motion::AxisColumns out{.tip_radius = 0.0, .closed = true};
  TRY(const auto joint, groove::joint_geometry(spec.groove));
  out.tip_radius = joint.root_radius;
  std::vector<double> c, x, z, b;
  for (std::size_t i = 0; i <= path.positions.size(); ++i) {
    const auto& at = path.positions[i % path.positions.size()].at;
    double turned = at.c.deg();
    if (i > 0) turned += 360.0 * std::round((c.back() - turned) / 360.0);
    c.push_back(turned);
    x.push_back(at.x);
    z.push_back(at.z);
    b.push_back(at.b.deg());
  }
  for (const auto& axis : machine.axes) {
    const auto* column = axis.name == "C"   ? &c
                         : axis.name == "X" ? &x
                         : axis.name == "Z" ? &z
                         : axis.name == "B" ? &b
                                            : nullptr;
    if (column == nullptr)
      return fail({.code = ErrorCode::unsupported_combination,
                   .member = "machine",
                   .got = axis.name,
                   .limit = "C, X, Z, B",
                   .hint = "a mill path needs a cone_mill with the axes C, X, Z and B"});
    out.columns.push_back(*column);
  }
  return out;
}

struct CutOf {
  const ScheduleRequest& request;
  ScheduleJob& job;

  Result<motion::Cut> operator()(const BevelTableRequest& asked) const {
    TRY(const auto spec, under("cut", resolve(asked)));
    TRY(const auto table, under("cut", on_node(spec.source, bevel::table(spec))));
    if (table.inward)
      return fail(
          {.code = ErrorCode::comparison_only, .member = "cut/dihedral", .limit = "weld_side"});
    job.checks = bevel::verify(spec, table);
    job.warnings = under("cut", on_node(spec.source, table.warnings));
    warn_of_land("cut/root_face_mm", {}, spec.root_face, job);
    return (*this)(contour_of(spec, table));
  }
  Result<motion::Cut> operator()(const SectionCutRequest& asked) const {
    TRY(const auto spec, under("cut", resolve(asked.table)));
    const auto& section = asked.section.section;
    TRY(const auto table, under("cut", on_node(spec.source, bevel::section_table(section, spec))));
    job.checks = bevel::verify(section, spec, table);
    job.warnings = under("cut", on_node(spec.source, table.warnings));
    warn_of_land("cut/root_face_mm", {}, spec.root_face, job);
    return (*this)(contour_of(section, table));
  }
  Result<motion::Cut> operator()(const groove::MillPathSpec& spec) const {
    TRY(const auto path, under("mill_path", groove::mill_path(spec)));
    job.checks = groove::verify(spec, path);
    job.warnings = under("mill_path", path.warnings);
    TRY(auto columns, columns_of(spec, path, request.machine));
    return motion::Cut{std::move(columns)};
  }
  Result<motion::Cut> operator()(const motion::CutPath& contour) const {
    return motion::Cut{motion::as_machine_counts(contour, request.machine.b_positive)};
  }
  Result<motion::Cut> operator()(const motion::AxisColumns& columns) const {
    return motion::Cut{columns};
  }
  /// Its cuts, one after the other, are those of `job.program`.
  Result<motion::Cut> operator()(const PartRequest& spec) const {
    TRY(add_part(request, spec, job));
    return motion::Cut{};
  }
};

bool is_section_cut(const CutSource& cut) {
  const auto* const part = std::get_if<PartRequest>(&cut);
  return std::holds_alternative<SectionCutRequest>(cut) || (part != nullptr && part->section);
}

/// Refuses a machine that cannot cut around a tube that is not round, next to all other problems.
void check_crosses(Reader& in, const motion::Machine& machine) {
  if (!in.sound("machine") || motion::crosses(machine)) return;
  const std::string name =
      machine.name.empty() ? std::string(motion::type_name(machine)) : machine.name;
  in.issue({.code = ErrorCode::unsupported_combination,
            .pointer = "machine",
            .got = Json{name},
            .limit = Json{std::string(motion::TubeTable::kName)},
            .hint = "the target is not round, and machine " + name +
                    " has no axis across the tube: take a machine of type tube_table"},
           in.find("machine"));
}

/// Requires the side of the scrap of a bare contour with a lead.
void check_scrap(Reader& in) {
  const auto* body = in.find("contour");
  if (!in.understood("contour") || body->find("scrap") != nullptr ||
      body->find("points") != nullptr)
    return;
  in.issue({.code = ErrorCode::missing_field,
            .pointer = "contour/scrap",
            .limit = Json{"-z|+z|inside"},
            .hint = "if a bare contour has a lead, scrap must name the side that falls away"});
}

}  // namespace

ScheduleRequest decode_schedule_request(Reader& in) {
  ScheduleRequest out;
  out.machine = decode_machine_choice(in, "machine");
  const auto chosen = in.exactly_one({"cut", "contour", "mill_path", "axes", "part"});
  switch (chosen.value_or(5)) {
    case 0:
      out.cut = in.object("cut", [](Reader& cut) -> CutSource {
        read_inner_common_fields(cut);
        if (cuts_section(cut)) return decode_section_cut_request(cut);
        return decode_bevel_table_request(cut);
      });
      break;
    case 1:
      out.cut = in.object("contour", decode_contour);
      break;
    case 2:
      out.cut = in.object("mill_path", [](Reader& path) {
        read_inner_common_fields(path);
        path.note("probe");
        if (path.has("probe"))
          path.issue({.code = ErrorCode::unsupported_combination,
                      .pointer = "probe",
                      .hint = "is answered only by /v1/mill-paths; omit it here"},
                     path.find("probe"));
        return decode_mill_path_request(path);
      });
      break;
    case 3:
      out.cut = in.object("axes", [&](Reader& axes) { return decode_axes(axes, out.machine); });
      break;
    case 4:
      out.cut = in.object("part", [](Reader& part) {
        read_inner_common_fields(part);
        return decode_part_request(part);
      });
      break;
    default:
      break;
  }
  if (const auto* const part = std::get_if<PartRequest>(&out.cut)) {
    const auto tube = part->section      ? Tube::section
                      : in.sound("part") ? Tube::round
                                         : Tube::unknown;
    auto asked =
        in.object("motion", [&](Reader& m) { return decode_part_motion(m, out.machine, tube); });
    out.motion = std::move(asked.motion);
    out.setup = asked.setup;
    out.marks = asked.marks;
  } else {
    const bool section = std::holds_alternative<SectionCutRequest>(out.cut);
    const bool certain = chosen && (chosen != 0U || section || in.sound("cut"));
    out.motion = in.object("motion", [&](Reader& m) { return decode_motion(m, out.cut, certain); });
  }
  if (is_section_cut(out.cut)) check_crosses(in, out.machine);
  if (std::holds_alternative<motion::CutPath>(out.cut) && out.motion.lead) check_scrap(in);
  out.max_periods =
      static_cast<std::int64_t>(in.binary() ? limit::periods_cbor_max : limit::periods_json_max);
  return out;
}

Result<ScheduleJob> compute_schedule_job(const ScheduleRequest& request) {
  ScheduleJob out;
  out.spec.machine = request.machine;
  out.spec.motion = request.motion;
  out.spec.max_periods = request.max_periods;
  TRY(auto cut, std::visit(CutOf{request, out}, request.cut));
  out.spec.cut = std::move(cut);
  return out;
}

}  // namespace tubecut::api
