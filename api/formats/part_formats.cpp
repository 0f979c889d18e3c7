#include "api/formats/part_formats.hpp"

#include "api/formats/csv.hpp"
#include "api/formats/development.hpp"
#include "api/formats/dstv.hpp"
#include "api/formats/dxf.hpp"
#include "api/formats/gcode.hpp"

namespace tubecut::api {
namespace {

/// Points of one cut, of an end or a hole, in common columns.
struct Rows {
  std::vector<std::string> cut;
  std::vector<double> phi, z_outer, phi_inner, z_inner, b, a, beam;
  std::vector<double> torch_phi, torch_outer, torch_phi_inner, torch_inner;

  void add(const std::string& name, const bevel::Table& t) {
    cut.insert(cut.end(), t.phi.size(), name);
    append(phi, t.phi);
    append(z_outer, t.z_outer);
    append(phi_inner, t.phi);
    append(z_inner, t.z_inner);
    append(b, t.b);
    a.insert(a.end(), t.phi.size(), 0.0);
    append(beam, t.beam);
    append(torch_phi, t.phi);
    append(torch_outer, t.torch_outer);
    append(torch_phi_inner, t.phi);
    append(torch_inner, t.torch_inner);
  }
  void add(const std::string& name, const bevel::Hole& h) {
    cut.insert(cut.end(), h.phi.size(), name);
    append(phi, h.phi);
    append(z_outer, h.z);
    append(phi_inner, h.phi_inner);
    append(z_inner, h.z_inner);
    append(b, h.b);
    append(a, h.a);
    append(beam, h.beam);
    append(torch_phi, h.torch_phi);
    append(torch_outer, h.torch_z);
    append(torch_phi_inner, h.torch_phi_inner);
    append(torch_inner, h.torch_z_inner);
  }

 private:
  static void append(std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  }
};

Rows rows(const part::Part& p) {
  Rows out;
  for (const auto& step : p.sequence) {
    if (step.what == part::Step::What::hole)
      out.add("hole " + std::to_string(step.index), p.holes[step.index].hole);
    if (step.what == part::Step::What::finish) out.add("finish", p.finish.table);
    if (step.what == part::Step::What::start) out.add("start", p.start.table);
  }
  return out;
}

}  // namespace

std::string_view name_of_mistake(part::Mistake mistake) {
  switch (mistake) {
    case part::Mistake::diameter:
      return "diameter";
    case part::Mistake::wall:
      return "wall";
    case part::Mistake::clocking:
      return "clocking";
    case part::Mistake::mirror:
      return "mirror";
    case part::Mistake::b_sign:
      return "b_sign";
    case part::Mistake::pivot_length:
      return "pivot_length";
  }
  return "";
}

std::string_view name_of_tool(part::Tool tool) {
  switch (tool) {
    case part::Tool::wrap:
      return "wrap";
    case part::Tool::tape:
      return "tape";
    case part::Tool::rule:
      return "rule";
    case part::Tool::caliper:
      return "caliper";
  }
  return "";
}

std::string part_csv(const part::PartSpec&, const part::Part& part, const Caption&) {
  auto r = rows(part);
  std::vector<std::string> names, from, tools;
  std::vector<double> values;
  for (const auto& d : part.check_dimensions) {
    names.push_back(d.name);
    values.push_back(d.value);
    tools.emplace_back(name_of_tool(d.tool));
    from.push_back(d.measured_from);
  }
  return Csv()
      .cells_column("cut", std::move(r.cut))
      .degrees("phi_deg", r.phi)
      .column("z_outer_mm", r.z_outer)
      .degrees("phi_inner_deg", r.phi_inner)
      .column("z_inner_mm", r.z_inner)
      .degrees("b_deg", r.b)
      .degrees("a_deg", r.a)
      .column("beam_mm", r.beam)
      .degrees("torch_phi_deg", r.torch_phi)
      .column("torch_outer_mm", r.torch_outer)
      .degrees("torch_phi_inner_deg", r.torch_phi_inner)
      .column("torch_inner_mm", r.torch_inner)
      .cells_column("check_dimension", std::move(names))
      .column("check_mm", values)
      .cells_column("check_tool", std::move(tools))
      .cells_column("check_measured_from", std::move(from))
      .print();
}

std::string part_dxf(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  return print_dxf(developed(spec, part), part.marks, caption);
}

std::string part_dstv(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  return print_dstv(spec, part, caption);
}

std::string part_gcode(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  return print_gcode(torch_job(spec, part), caption);
}

}  // namespace tubecut::api
