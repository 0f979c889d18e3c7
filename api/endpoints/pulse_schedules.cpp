#include "api/endpoints/all.hpp"
#include "api/endpoints/motion_codec.hpp"
#include "api/endpoints/work.hpp"
#include "api/formats/schedule_formats.hpp"
#include "api/formats/schedule_gcode.hpp"
#include "api/limits.hpp"
#include "api/machines.hpp"
#include "api/pipeline.hpp"
#include "core/base/try.hpp"
#include "core/motion/replay.hpp"

namespace tubecut::api {
namespace {

void encode_uses(const std::vector<motion::Use>& uses, Writer& w) {
  w.object("max_use", [&](Writer& o) {
    for (const auto& use : uses)
      o.field(
          use.axis.empty() ? std::string(1, use.limit) : std::string(1, use.limit) + "_" + use.axis,
          use.share);
  });
}

void encode_report(const motion::Schedule& s, Writer& w) {
  const auto& r = s.report;
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
    if (r.edges) {
      o.field("dev_outer_edge_mm", r.edges->outer);
      o.field("dev_inner_edge_mm", r.edges->inner);
    }
    o.field("min_tip_mm_min", r.least_tip * 60.0);
    o.field("slow_s", r.slow_time);
    o.field("standoff_growth_mm", r.standoff_growth);
    o.field("closing_residual_pulses", r.closing_residual);
    o.object("peak", [&](Writer& p) {
      for (const auto& axis : s.axes) p.field(axis.name, axis.peak);
    });
    o.object("closure", [&](Writer& p) {
      for (const auto& axis : s.axes) p.field(axis.name, axis.closure);
    });
    encode_uses(r.max_use, o);
    o.array("slow", r.slow, [](Writer& each, const motion::SlowZone& zone) {
      each.object([&](Writer& z) {
        z.field("from", zone.from);
        z.field("to", zone.to);
        z.degrees("from_phi_deg", zone.phi_from);
        z.degrees("to_phi_deg", zone.phi_to);
        z.field("min_mm_min", zone.least_speed * 60.0);
        z.field("axis", zone.axis);
      });
    });
  });
}

void encode_comparison(const motion::Comparison& c, Writer& w) {
  w.object("comparison", [&](Writer& o) {
    o.field("whole_cut_mm_min", c.whole_cut_speed * 60.0);
    o.field("whole_cut_s", c.whole_cut_time);
    o.field("slow_segments", c.slow_segments);
    o.field("segments_s", c.segments_time);
    o.field("segments_stop_s", c.segments_stop_time);
    o.object("naive", [&](Writer& n) {
      n.column("end_s", std::vector(c.naive.time.begin() + 1, c.naive.time.end()));
      n.array("axes", c.naive.axes, [](Writer& each, const motion::NaiveAxis& axis) {
        each.object([&](Writer& a) {
          a.field("name", axis.name);
          a.field("peak_pulses", axis.peak);
          if (axis.periods_over) a.field("periods_over", *axis.periods_over);
          a.field("largest_step_pulses", axis.largest_step);
          a.field("step_in_16_bits", std::int64_t{axis.step_in_16_bits()});
          a.column("pulses", axis.pulses);
        });
      });
    });
  });
}

struct PulseSchedules {
  using Spec = ScheduleRequest;
  struct Out {
    ScheduleJob job;
    motion::Schedule schedule;
  };
  static constexpr std::string_view kId = "pulse-schedules";
  static constexpr std::string_view kPath = "/v1/pulse-schedules";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_large_max_bytes);
  static constexpr double kBudgetS = kLongBudgetS;
  static constexpr std::array<std::string_view, 1> kAccepts{"max_slow_s"};
  static constexpr std::array<CheckLimit, 3> kChecks{{
      {"I1..I16", "docs/theory/pulse-schedules.md, section 9", ""},
      {"lead_clears_part", "0.02 and the contour's sag", "mm"},
      {"nested cut", "the checks of its own endpoint", ""},
  }};

  static Spec decode(Reader& in) { return decode_schedule_request(in); }

  static void count(const Spec& spec, Work& work) { add_schedule_work(spec, work); }
  static Result<Out> compute(const Spec& spec, const std::stop_token& stop) {
    TRY(auto job, compute_schedule_job(spec, stop));
    TRY(auto schedule, motion::schedule(job.spec, stop));
    return Out{std::move(job), std::move(schedule)};
  }

  static std::vector<Check> verify(const Spec&, const Out& out, const std::stop_token& stop) {
    auto checks = out.job.checks;
    for (auto& check : motion::verify(out.job.spec, out.schedule, stop))
      checks.push_back(std::move(check));
    return checks;
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) {
    auto all = out.job.warnings;
    all.insert(all.end(), out.schedule.warnings.begin(), out.schedule.warnings.end());
    return all;
  }
  static std::vector<Measure> measure(const Spec&, const Out& out) {
    return {{"max_slow_s", out.schedule.report.slow_time}};
  }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    const auto& s = out.schedule;
    std::vector<std::string> moving, idle;
    for (const auto& axis : s.axes) (axis.idle() ? idle : moving).push_back(axis.name);
    w.field("machine_sha256", machine_sha256(spec.machine));
    w.field("period_us", std::round(s.period * 1e9) / 1e3);
    w.field("periods", s.periods);
    w.column("axes", moving);
    w.column("idle", idle);
    w.object("counts", [&](Writer& o) {
      for (const auto& axis : s.axes)
        if (!axis.idle()) o.column(axis.name, axis.counts);
    });
    w.object("start", [&](Writer& o) {
      for (const auto& axis : s.axes) o.field(axis.name, axis.start);
    });
    w.object("total", [&](Writer& o) {
      for (const auto& axis : s.axes) o.field(axis.name, axis.total);
    });
    w.array("events", s.events, [](Writer& each, const motion::Event& event) {
      each.object([&](Writer& o) {
        o.field("period", event.period);
        o.field("what", motion::name_of(event.what));
      });
    });
    encode_report(s, w);
    if (s.comparison) encode_comparison(*s.comparison, w);
  }

  static std::string csv(const Spec&, const Out& out, const Caption& caption) {
    return schedule_csv(out.schedule, caption);
  }
  static std::string svg(const Spec&, const Out& out, const Caption& caption) {
    return schedule_svg(out.job.spec, out.schedule, caption);
  }
  static std::string gcode(const Spec& spec, const Out& out, const Caption& caption) {
    return print_schedule_gcode(spec.machine, out.job.spec, out.schedule, caption);
  }
  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &csv},
        {"svg", "image/svg+xml", &svg, {"chart"}},
        {"gcode",
         "text/x-gcode",
         &gcode,
         {},
         {"post", "dialect", "torch", "acknowledge"},
         false,
         true}};
    return kFormats;
  }
};

}  // namespace

Endpoint pulse_schedules() { return endpoint<PulseSchedules>(); }

}  // namespace tubecut::api
