#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "api/catalog/machines.hpp"
#include "api/endpoints/all.hpp"
#include "api/endpoints/motion/motion_codec.hpp"
#include "api/endpoints/motion/schedule_answer.hpp"
#include "api/formats/gcode/schedule_gcode.hpp"
#include "api/formats/schedule_formats.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/motion_names.hpp"
#include "core/base/try.hpp"
#include "core/motion/replay/replay.hpp"
#include "core/torch/program_replay.hpp"

namespace tubecut::api {
namespace {

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
    motion::Schedule schedule = {};                      // of one cut
    std::optional<torch::ProgramSchedule> program = {};  // of a part

    [[nodiscard]] const motion::Schedule& all() const {
      return program ? program->whole : schedule;
    }
  };
  static constexpr std::string_view kId = "pulse-schedules";
  static constexpr std::string_view kPath = "/v1/pulse-schedules";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_large_max_bytes);
  static constexpr double kBudgetS = kLongBudgetS;
  static constexpr std::array<std::string_view, 1> kAccepts{"max_slow_s"};
  static constexpr std::array<CheckLimit, 9> kChecks{{
      {"I1..I16", "docs/theory/pulse-schedules.md, section 9", ""},
      {"lead_clears_part", "0.02 and the contour's sag", "mm"},
      {"segments_join", "0", ""},
      {"torch_lit", "0", "periods"},
      {"pierce_place", "half a pulse of every axis", "mm"},
      {"pierce_delay", "0", "s"},
      {"tab_width", "half a pulse of every axis, on both sides", "mm"},
      {"rapid_clearance", "half a pulse of height and swing", "mm"},
      {"nested cut", "the checks of its own endpoint", ""},
  }};

  static Spec decode(Reader& in) { return decode_schedule_request(in); }

  static Result<Spec> resolve(Spec spec) { return api::resolve(std::move(spec)); }
  static Result<Out> compute(const Spec& spec) {
    TRY(auto job, compute_schedule_job(spec));
    if (job.program) {
      TRY(auto program, torch::schedule(*job.program));
      return Out{.job = std::move(job), .program = std::move(program)};
    }
    TRY(auto schedule, motion::schedule(job.spec));
    return Out{.job = std::move(job), .schedule = std::move(schedule)};
  }

  static std::vector<Check> verify(const Spec&, const Out& out) {
    auto checks = out.job.checks;
    auto own = out.program ? torch::verify(*out.job.program, *out.program)
                           : motion::verify(out.job.spec, out.schedule);
    std::ranges::move(own, std::back_inserter(checks));
    return checks;
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) {
    auto all = out.job.warnings;
    const auto& own = out.all().warnings;
    all.insert(all.end(), own.begin(), own.end());
    return all;
  }
  static std::vector<Measure> measure(const Spec&, const Out& out) {
    return {{"max_slow_s", out.all().report.slow_time}};
  }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    const auto& s = out.all();
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
    w.array("events", s.events, [&](Writer& each, const motion::Event& event) {
      each.object([&](Writer& o) {
        o.field("period", event.period);
        o.field("what", name_of(event.what));
        if (out.program) o.field("cut", out.program->cuts[event.cut].cut.name);
      });
    });
    encode_report(s.report, sums_of(s), w);
    if (out.program) encode_segments(out.job, *out.program, w);
    if (s.comparison) encode_comparison(*s.comparison, w);
  }

  static std::string csv(const Spec&, const Out& out, const Caption& caption) {
    return schedule_csv(out.all(), caption);
  }
  static std::string svg(const Spec&, const Out& out, const Caption& caption) {
    return schedule_svg(out.job.spec, out.all(), caption);
  }
  static std::string gcode(const Spec& spec, const Out& out, const Caption& caption) {
    std::vector<std::string> names;
    if (out.program)
      for (const auto& cut : out.program->cuts) names.push_back(cut.cut.name);
    return print_schedule_gcode(spec.machine, out.job.spec, out.all(), names, caption);
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
