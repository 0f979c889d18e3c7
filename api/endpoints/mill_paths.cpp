#include <optional>
#include <utility>
#include <vector>

#include "api/endpoints/all.hpp"
#include "api/endpoints/groove_codec.hpp"
#include "api/formats/groove_formats.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/tables.hpp"
#include "core/base/try.hpp"
#include "core/groove/probe.hpp"

namespace tubecut::api {
namespace {

void encode_swept(std::string_view name, const groove::Swept& swept, Writer& w) {
  w.object(name, [&](Writer& o) {
    o.field("flank_min_mm", swept.flank_min.value);
    o.field("flank_max_mm", swept.flank_max.value);
    o.field("stock_left_max_mm", swept.stock_left_max.value);
    o.field("root_face_min_mm", swept.root_face_min.value);
  });
}

constexpr std::size_t kMostProbed = 1000;

struct ProbedSpec : groove::MillPathSpec {
  std::vector<groove::ProbePoint> probe;
};
struct ProbedPath : groove::MillPath {
  std::optional<groove::Probe> seen;  // if requested
};

std::vector<groove::ProbePoint> decode_probe(Reader& in) {
  in.note("probe");
  if (!in.has("probe")) return {};
  return in.array("probe", {.min = 1, .max = kMostProbed}, [](Reader& p) {
    groove::ProbePoint out;
    out.omega = p.angle("omega_deg", kAnyAngleDeg);
    out.ruling = p.angle("ruling_deg", kAnyAngleDeg);
    out.v = p.number("v", {.min = 0.0, .max = 1.0});
    return out;
  });
}

void encode_point(const Eigen::Vector3d& point, Writer& o) {
  o.field("x_mm", point.x());
  o.field("y_mm", point.y());
  o.field("z_mm", point.z());
}

void encode_deepest(std::string_view name, const groove::Deepest& place, Writer& w) {
  w.object(name, [&](Writer& o) {
    o.degrees("omega_deg", place.at.omega.rad());
    o.degrees("ruling_deg", place.at.ruling.rad());
    o.field("v", place.at.v);
    encode_point(place.point, o);
    o.field("distance_mm", place.distance);
  });
}

void encode_probe(const ProbedSpec& spec, const groove::Probe& seen, Writer& w) {
  w.object("probe", [&](Writer& o) {
    std::size_t i = 0;
    o.array("points", seen.points, [&](Writer& each, const groove::Probed& one) {
      const auto& asked = spec.probe[i++];
      each.object([&](Writer& p) {
        p.degrees("omega_deg", asked.omega.rad());
        p.degrees("ruling_deg", asked.ruling.rad());
        p.field("v", asked.v);
        encode_point(one.point, p);
        p.field("distance_before_mm", one.before);
        p.field("distance_mm", one.after);
      });
    });
    encode_deepest("overcut_before", seen.before.over, o);
    encode_deepest("undercut_before", seen.before.under, o);
    encode_deepest("overcut", seen.after.over, o);
    encode_deepest("undercut", seen.after.under, o);
  });
}

struct MillPaths {
  using Spec = ProbedSpec;
  using Out = ProbedPath;
  static constexpr std::string_view kId = "mill-paths";
  static constexpr std::string_view kPath = "/v1/mill-paths";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr double kBudgetS = kLongBudgetS;
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr std::array<CheckLimit, 9> kChecks{{
      {"initial_on_ruling", "1e-12 of all lengths on the way into the machine", "mm"},
      {"contact_gap", "1e-9", "mm"},
      {"contact_least", "1e-9", "mm"},
      {"cut_figures", "1e-9", "mm"},
      {"certificate", "1e-9", "mm"},
      {"axis_sag", "1.2e-3", "mm"},
      {"swept", "1e-6", "mm"},
      {"root_face", "1e-6", "mm"},
      {"probe", "1e-9", "mm"},
  }};

  static Spec decode(Reader& in) {
    Spec out{decode_mill_path_request(in), {}};
    out.probe = decode_probe(in);
    return out;
  }
  static Result<Out> compute(const Spec& spec) {
    TRY(auto path, groove::mill_path(spec));
    Out out{std::move(path), {}};
    if (!spec.probe.empty()) {
      TRY(out.seen, groove::probe(spec, out, spec.probe));
    }
    return out;
  }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    auto checks = groove::verify(static_cast<const groove::MillPathSpec&>(spec), out);
    if (out.seen) checks.push_back(groove::verify(spec, spec.probe, *out.seen));
    return checks;
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    w.object("positions", [&](Writer& o) { position_columns(out).write(o); });
    encode_swept("swept", out.swept, w);
    encode_swept("swept_at_positions", out.swept_at_optima, w);
    w.field("qualified", out.qualified);
    if (out.seen) encode_probe(spec, *out.seen, w);
  }

  template <auto Print>
  static std::string print(const Spec& spec, const Out& out, const Caption& caption) {
    return Print(spec, out, caption);
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &print<mill_path_csv>},
        {"svg", "image/svg+xml", &print<mill_path_svg>, {"chart"}},
        {"glb", "model/gltf-binary", &print<mill_path_gltf>}};
    return kFormats;
  }
};

}  // namespace

Endpoint mill_paths() { return endpoint<MillPaths>(); }

}  // namespace tubecut::api
