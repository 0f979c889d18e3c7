#include "api/endpoints/motion/schedule_answer.hpp"

#include "api/wire/motion_names.hpp"

namespace tubecut::api {
namespace {

using Kind = torch::Segment::Kind;

void encode_uses(const std::vector<motion::Use>& uses, Writer& w) {
  w.object("max_use", [&](Writer& o) {
    for (const auto& use : uses)
      o.field(
          use.axis.empty() ? std::string(1, use.limit) : std::string(1, use.limit) + "_" + use.axis,
          use.share);
  });
}

}  // namespace

void encode_report(const motion::Report& r, const std::vector<AxisSums>& sums, Writer& w) {
  w.object("report", [&](Writer& o) {
    o.field("time_s", r.time);
    o.field("ideal_s", r.ideal);
    o.field("no_jerk_s", r.no_jerk);
    o.field("proven_s", r.proven);
    o.field("optimality", r.optimality);
    o.field("filter_ms", r.filter * 1e3);
    o.field("stretch", r.stretch);
    o.field("length_mm", r.length);
    o.field("dev_tip_mm", r.deviation_tip);
    o.degrees("dev_b_deg", r.deviation_b);
    o.field("sag_mm", r.sag_tip);
    o.degrees("sag_b_deg", r.sag_b);
    if (r.lean) o.degrees("lean_deg", *r.lean);
    if (r.edges) {
      o.field("dev_outer_edge_mm", r.edges->outer);
      o.field("dev_inner_edge_mm", r.edges->inner);
    }
    o.field("min_tip_mm_min", r.least_tip * 60.0);
    o.field("slow_s", r.slow_time);
    o.field("standoff_growth_mm", r.standoff_growth);
    o.field("closing_residual_pulses", r.closing_residual);
    o.object("peak", [&](Writer& p) {
      for (const auto& axis : sums) p.field(axis.name, axis.peak);
    });
    o.object("closure", [&](Writer& p) {
      for (const auto& axis : sums) p.field(axis.name, axis.closure);
    });
    encode_uses(r.max_use, o);
    const bool section = r.lean.has_value();
    o.array("slow", r.slow, [&](Writer& each, const motion::SlowZone& zone) {
      each.object([&](Writer& z) {
        z.field("from", zone.from);
        z.field("to", zone.to);
        z.degrees(section ? "from_normal_deg" : "from_phi_deg", zone.phi_from);
        z.degrees(section ? "to_normal_deg" : "to_phi_deg", zone.phi_to);
        z.field("min_mm_min", zone.least_speed * 60.0);
        z.field("axis", zone.axis);
      });
    });
  });
}

namespace {

/// For a single cut: with a lead, and for a segment or a mark, it ends at another point than its
/// start.
std::vector<AxisSums> sums_of(const ScheduleJob& job, const torch::ProgramCut& cut,
                              const torch::Segment& segment) {
  const bool closed = !job.program->setup.lead && !cut.way.points.stretch && !cut.cut.mark;
  std::vector<AxisSums> out;
  for (const auto& axis : job.program->machine.axes) {
    const auto a = out.size();
    const auto total = closed ? segment.sums.total[a] : 0;
    out.push_back({axis.name, segment.sums.peak[a],
                   axis.pulses_per_turn > 0 ? total % axis.pulses_per_turn : total});
  }
  return out;
}

/// The places of a tube that is not round are girths.
void encode_way(const torch::ProgramCut& cut, Writer& w) {
  const auto& points = cut.way.points.points;
  const bool section = cut.cut.path.section.has_value();
  const auto girth = [&](const motion::CutPoint& p) { return cut.cut.path.outer_radius * p.phi; };
  const auto column = [&](double motion::CutPoint::*member) {
    std::vector<double> out;
    for (const auto& point : points) out.push_back(point.*member);
    return out;
  };
  w.object("start", [&](Writer& o) {
    const auto& at = points[cut.way.points.cut_first];
    if (section)
      o.field("girth_mm", girth(at));
    else
      o.degrees("phi_deg", at.phi);
    o.field("z_mm", at.z);
    o.degrees("b_deg", at.b);
    o.field("why", name_of(cut.start));
  });
  w.field("lead_radius_mm", cut.way.radius);
  w.object("way", [&](Writer& o) {
    if (section) {
      std::vector<double> girths;
      for (const auto& point : points) girths.push_back(girth(point));
      o.column("girth_mm", girths);
    } else {
      o.degrees_column("phi_deg", column(&motion::CutPoint::phi));
    }
    o.column("z_mm", column(&motion::CutPoint::z));
    o.degrees_column("b_deg", column(&motion::CutPoint::b));
    o.field("cut_first", cut.way.points.cut_first);
    o.field("cut_last", cut.way.points.cut_last);
    o.field("b_sign", kBSignInPart);
  });
}

}  // namespace

std::vector<AxisSums> sums_of(const motion::Schedule& s) {
  std::vector<AxisSums> out;
  for (const auto& axis : s.axes) out.push_back({axis.name, axis.peak, axis.closure});
  return out;
}

void encode_segments(const ScheduleJob& job, const torch::ProgramSchedule& s, Writer& w) {
  w.array("segments", s.segments, [&](Writer& each, const torch::Segment& segment) {
    each.object([&](Writer& o) {
      const auto& cut = s.cuts[segment.cut];
      o.field("name", cut.cut.name);
      o.field("kind", name_of(segment.kind));
      o.field("from", segment.from);
      o.field("to", segment.to);
      if (!segment.report) return;
      encode_way(cut, o);
      encode_report(*segment.report, sums_of(job, cut, segment), o);
    });
  });
  w.object("times", [&](Writer& o) {
    o.field("total_s", static_cast<double>(s.whole.periods) * s.whole.period);
    o.field("cut_s", s.time_of(Kind::cut));
    o.field("pierce_s", s.time_of(Kind::pierce));
    o.field("rapid_s", s.time_of(Kind::rapid));
    if (const double marks = s.time_of(Kind::mark); marks > 0.0) o.field("mark_s", marks);
  });
}

}  // namespace tubecut::api
