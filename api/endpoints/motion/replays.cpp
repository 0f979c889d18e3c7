#include <array>
#include <string_view>
#include <utility>

#include "api/endpoints/all.hpp"
#include "api/endpoints/motion/motion_codec.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/motion_names.hpp"
#include "core/base/try.hpp"
#include "core/motion/replay/replay.hpp"
#include "core/torch/program_replay.hpp"

namespace tubecut::api {
namespace {

constexpr auto kMostPeriods = static_cast<std::size_t>(limit::periods_cbor_max);

/// A schedule's result as it came back; only the period, the counts and the start are read.
struct Schedule {
  double period = 0.0;
  std::vector<std::vector<double>> counts;
  std::vector<double> start;
  std::vector<torch::Segment> segments;  // of a part
  std::vector<motion::Event> events;
};

/// Decodes the type of each segment, and the torch's on and off times, because the counts do not
/// contain them.
void decode_segments(Reader& in, Schedule& out) {
  constexpr auto kLast = static_cast<int>(kMostPeriods);
  // Of 64 branches, each through both sides, and two ends, each in as many stretches as it may have
  // tabs; and two strokes for each of 64 partners at both ends.
  constexpr CountRange kSegments{.min = 1, .max = 5'500}, kEvents{.min = 1, .max = 16'500};
  out.segments = in.array("segments", kSegments, [&](Reader& s) {
    for (const auto* other : {"name", "start", "lead_radius_mm", "way", "report"}) s.note(other);
    torch::Segment segment{.kind = s.choice("kind", kNames<torch::Segment::Kind>)};
    segment.from = s.integer("from", 0, kLast);
    segment.to = s.integer("to", 0, kLast);
    return segment;
  });
  out.events = in.array("events", kEvents, [&](Reader& e) {
    e.note("cut");
    motion::Event event{.period = e.integer("period", 0, kLast)};
    event.what = e.choice("what", kNames<motion::EventKind>);
    return event;
  });
}

Schedule decode_schedule(Reader& in, const motion::Machine& machine, bool part) {
  for (const auto* other : {"machine_sha256", "periods", "axes", "idle", "total", "events",
                            "report", "comparison", "segments", "times"})
    in.note(other);
  Schedule out;
  out.period = in.number("period_us", {.min = 50.0, .max = 1e6}) * 1e-6;
  in.object("counts", [&](Reader& c) {
    for (const auto& axis : machine.axes) {
      c.note(axis.name);
      out.counts.push_back(c.has(axis.name) ? c.column(axis.name, {.min = 1, .max = kMostPeriods})
                                            : std::vector<double>{});
    }
    return 0;
  });
  in.object("start", [&](Reader& s) {
    for (const auto& axis : machine.axes)
      out.start.push_back(s.number(axis.name, {.min = -1e9, .max = 1e9}));
    return 0;
  });
  if (part) decode_segments(in, out);
  return out;
}

constexpr std::string_view kBlindSpot =
    "Counts of one axis put in another order, their sum kept, are seen only where the torch leaves "
    "the path, or its B the contour's, by more than this.";

/// The limits from which on it is seen after all, by the invariants that have them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kSeenFrom{
    {{"off_path_mm", "I10"}, {"b_deg", "I12"}}};

Result<motion::Replay> replayed(const Schedule& s, ScheduleJob& job) {
  if (job.program)
    return torch::replay({.job = *std::move(job.program),
                          .period = s.period,
                          .counts = s.counts,
                          .start = s.start,
                          .segments = s.segments,
                          .events = s.events});
  return motion::replay(
      {.job = std::move(job.spec), .period = s.period, .counts = s.counts, .start = s.start});
}

struct Replays {
  struct Spec {
    ScheduleRequest job;
    Schedule schedule;
  };
  struct Out {
    motion::Replay replay;
    std::vector<Check> checks;
    std::vector<Warning> warnings;
  };
  static constexpr std::string_view kId = "replays";
  static constexpr std::string_view kPath = "/v1/replays";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_large_max_bytes);
  static constexpr double kBudgetS = kLongBudgetS;
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr std::array<CheckLimit, 2> kChecks{
      {{"path_points", "0", ""}, {"nested cut", "the checks of its own endpoint", ""}}};

  static Spec decode(Reader& in) {
    Spec out;
    out.job = decode_schedule_request(in);
    const bool known = in.sound("machine");
    out.schedule = in.object("schedule", [&](Reader& s) {
      if (!known) s.silence();  // its members follow from the machine's axes
      return decode_schedule(s, out.job.machine, std::holds_alternative<PartRequest>(out.job.cut));
    });
    return out;
  }

  static Result<Spec> resolve(Spec spec) {
    TRY(spec.job, api::resolve(std::move(spec.job)));
    return spec;
  }
  static Result<Out> compute(const Spec& spec) {
    TRY(auto job, compute_schedule_job(spec.job));
    TRY(auto replay, replayed(spec.schedule, job));
    Out out{std::move(replay), std::move(job.checks), std::move(job.warnings)};
    for (const auto& invariant : out.replay.invariants)
      if (!invariant.passed())
        out.warnings.push_back({.code = WarningCode::invariant_broken,
                                .member = "schedule",
                                .detail = invariant.name + " is " + shown(invariant.value) +
                                          ", limit " + shown(invariant.limit) + " " +
                                          invariant.unit});
    return out;
  }

  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    auto checks = out.checks;
    std::size_t periods = 0;
    for (const auto& counts : spec.schedule.counts) periods = std::max(periods, counts.size());
    const auto points = out.replay.phi.empty() ? periods + 1 : out.replay.phi.size();
    const auto wanted = static_cast<double>(periods + 1);
    checks.push_back({"path_points", std::abs(static_cast<double>(points) - wanted), 0.0, ""});
    return checks;
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    auto b = out.replay.b;
    if (spec.job.machine.b_positive == motion::BPositive::outer_edge_to_waste)
      for (auto& v : b) v = -v;
    w.object("path", [&](Writer& o) {
      const bool section = !out.replay.x.empty();
      o.degrees_column(section ? "normal_deg" : "phi_deg", out.replay.phi);
      if (section) o.column("x_mm", out.replay.x);
      if (section) o.column("y_mm", out.replay.y);
      o.column("z_mm", out.replay.z);
      o.degrees_column("b_deg", b);
    });
    w.field("deviation_mm", out.replay.deviation);
    w.object("blind_spot", [&](Writer& o) {
      for (const auto& [field, name] : kSeenFrom)
        for (const auto& check : out.replay.invariants)
          if (check.name == name) o.field(field, check.limit);
      o.field("detail", kBlindSpot);
    });
    w.array("invariants", out.replay.invariants, [](Writer& each, const Check& check) {
      each.object([&](Writer& o) {
        o.field("name", check.name);
        o.field("passed", check.passed());
        o.field("value", check.value);
        o.field("limit", check.limit);
        o.field("unit", check.unit);
      });
    });
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kNone;
    return kNone;
  }
};

}  // namespace

Endpoint replays() { return endpoint<Replays>(); }

}  // namespace tubecut::api
