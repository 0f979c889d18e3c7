#include "api/endpoints/all.hpp"
#include "api/endpoints/groove_codec.hpp"
#include "api/formats/groove_formats.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/tables.hpp"

namespace tubecut::api {
namespace {

struct Grooves {
  using Spec = groove::GrooveSpec;
  using Out = groove::Groove;
  static constexpr std::string_view kId = "grooves";
  static constexpr std::string_view kPath = "/v1/grooves";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr double kBudgetS = api::kBudgetS;
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr std::array<CheckLimit, 13> kChecks{{
      {"on_chord", "1e-13 (R + r)/sin(inclination)", "mm"},
      {"weld_width", "1e-13 (R + r)/sin(inclination)", "mm"},
      {"filler_area", "1e-10 area + rounding", "mm2"},
      {"area_sum", "1e-10 area + rounding", "mm2"},
      {"curves", "1e-13 (R + r)/sin(inclination)", "mm"},
      {"twist", "1e-4", "deg"},
      {"heights", "1e-9", "ratio"},
      {"least_area", "1e-9", "ratio"},
      {"filler_volume", "2e-5", "ratio"},
      {"weld_length", "1e-4", "ratio"},
      {"normal_area", "1e-3", "ratio"},
      {"compare_area", "1e-10 area + rounding", "mm2"},
      {"compare_volume", "2e-5", "ratio"},
  }};

  static Spec decode(Reader& in) { return decode_groove_request(in); }
  static Result<Out> compute(const Spec& spec) { return groove::groove(spec); }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    return groove::verify(spec, out);
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec&, const Out& out, Writer& w) {
    w.object("sections", [&](Writer& o) { section_columns(out).write(o); });
    w.object("curves", [&](Writer& o) {
      for (const auto& [name, points] : kCurves)
        o.object(name, [&](Writer& c) { curve_columns(out, points).write(c); });
    });
    w.field("filler_area_mm2", out.area);
    w.field("least_area_mm2", out.least_area);
    w.field("height_min_mm", out.height_min);
    w.field("height_max_mm", out.height_max);
    w.field("filler_volume_mm3", out.filler_volume);
    w.field("weld_length_mm", out.weld_length);
    if (!out.compare) return;
    w.object("compare", [&](Writer& o) {
      o.field("height_mm", out.compare->height);
      compare_columns(*out.compare).write(o);
      o.field("filler_volume_mm3", out.compare->filler_volume);
    });
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &groove_csv},
        {"svg", "image/svg+xml", &groove_svg, {"chart", "section"}, {"omega_deg"}},
        {"glb", "model/gltf-binary", &groove_gltf}};
    return kFormats;
  }
};

}  // namespace

Endpoint grooves() { return endpoint<Grooves>(); }

}  // namespace tubecut::api
