#include "api/endpoint.hpp"
#include "api/endpoints/all.hpp"
#include "api/endpoints/groove_codec.hpp"
#include "api/formats/groove_formats.hpp"

namespace tubecut::api {
namespace {

using groove::MillPosition;

template <class F>
std::vector<double> each(const std::vector<MillPosition>& positions, F value) {
  std::vector<double> out;
  out.reserve(positions.size());
  for (const auto& position : positions) out.push_back(value(position));
  return out;
}

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
  static Result<Out> compute(const Spec& spec, const std::stop_token& stop) {
    return groove::mill_path(spec, stop);
  }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    return groove::verify(spec, out);
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec&, const Out& out, Writer& w) {
    w.object("positions", [&](Writer& o) { encode_positions(out.positions, o); });
    encode_swept("swept", out.swept, w);
    encode_swept("swept_at_positions", out.swept_at_optima, w);
    w.field("qualified", out.qualified);
  }

  static void encode_positions(const std::vector<MillPosition>& all, Writer& o) {
    using P = const MillPosition&;
    o.degrees_column("omega_deg", each(all, [](P p) { return p.omega.rad(); }));
    o.degrees_column("c_deg", each(all, [](P p) { return p.at.c.rad(); }));
    o.column("x_mm", each(all, [](P p) { return p.at.x; }));
    o.column("z_mm", each(all, [](P p) { return p.at.z; }));
    o.degrees_column("b_deg", each(all, [](P p) { return p.at.b.rad(); }));
    o.column("dz_mm", each(all, [](P p) { return p.by.dz; }));
    o.degrees_column("db_deg", each(all, [](P p) { return p.by.db; }));
    o.column("overcut_before_mm", each(all, [](P p) { return p.before.over; }));
    o.column("undercut_before_mm", each(all, [](P p) { return p.before.under; }));
    o.column("overcut_mm", each(all, [](P p) { return p.after.over; }));
    o.column("undercut_mm", each(all, [](P p) { return p.after.under; }));
    o.column("gap_before_mm", each(all, [](P p) { return p.before.largest; }));
    o.column("gap_mm", each(all, [](P p) { return p.after.largest; }));
    o.column("grid_overcut_before_mm", each(all, [](P p) { return p.grid_before.over; }));
    o.column("grid_undercut_before_mm", each(all, [](P p) { return p.grid_before.under; }));
    o.column("grid_overcut_mm", each(all, [](P p) { return p.grid.over; }));
    o.column("grid_undercut_mm", each(all, [](P p) { return p.grid.under; }));
    o.column("certificate_mm", each(all, [](P p) { return p.certificate; }));
    std::vector<int> evaluations;
    std::vector<bool> qualified, optimised;
    for (const auto& p : all) {
      evaluations.push_back(p.evaluations);
      qualified.push_back(p.qualified);
      optimised.push_back(p.optimised);
    }
    o.column("evaluations", evaluations);
    o.flags("qualified", qualified);
    o.flags("optimised", optimised);
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
