#include "api/endpoints/all.hpp"
#include "api/endpoints/groove_codec.hpp"
#include "api/endpoints/work.hpp"
#include "api/formats/groove_formats.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/tables.hpp"

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

struct MillPaths {
  using Spec = groove::MillPathSpec;
  using Out = groove::MillPath;
  static constexpr std::string_view kId = "mill-paths";
  static constexpr std::string_view kPath = "/v1/mill-paths";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr double kBudgetS = kLongBudgetS;
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr std::array<CheckLimit, 8> kChecks{{
      {"initial_on_ruling", "1e-12 of all lengths on the way into the machine", "mm"},
      {"contact_gap", "1e-9", "mm"},
      {"contact_least", "1e-9", "mm"},
      {"cut_figures", "1e-9", "mm"},
      {"certificate", "1e-9", "mm"},
      {"axis_sag", "1.2e-3", "mm"},
      {"swept", "1e-6", "mm"},
      {"root_face", "1e-6", "mm"},
  }};

  static Spec decode(Reader& in) { return decode_mill_path_request(in); }
  static void count(const Spec& spec, Work& work) { add_work(spec, work); }
  static Result<Out> compute(const Spec& spec, const std::stop_token& stop) {
    return groove::mill_path(spec, stop);
  }
  static std::vector<Check> verify(const Spec& spec, const Out& out, const std::stop_token& stop) {
    return groove::verify(spec, out, stop);
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec&, const Out& out, Writer& w) {
    w.object("positions", [&](Writer& o) { position_columns(out).write(o); });
    encode_swept("swept", out.swept, w);
    encode_swept("swept_at_positions", out.swept_at_optima, w);
    w.field("qualified", out.qualified);
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &mill_path_csv},
        {"svg", "image/svg+xml", &mill_path_svg, {"chart"}},
        {"glb", "model/gltf-binary", &mill_path_gltf}};
    return kFormats;
  }
};

}  // namespace

Endpoint mill_paths() { return endpoint<MillPaths>(); }

}  // namespace tubecut::api
