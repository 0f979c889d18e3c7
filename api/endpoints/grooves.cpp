#include "api/endpoint.hpp"
#include "api/endpoints/all.hpp"
#include "api/endpoints/groove_codec.hpp"
#include "api/formats/groove_formats.hpp"

namespace tubecut::api {
namespace {

using groove::GrooveSection;

/// One number of every section.
template <class F>
std::vector<double> each(const std::vector<GrooveSection>& sections, F value) {
  std::vector<double> out;
  out.reserve(sections.size());
  for (const auto& section : sections) out.push_back(value(section));
  return out;
}

struct Grooves {
  using Spec = groove::GrooveSpec;
  using Out = groove::Groove;
  static constexpr std::string_view kId = "grooves";
  static constexpr std::string_view kPath = "/v1/grooves";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr std::array<CheckLimit, 12> kChecks{{
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
      {"compare_area", "1e-10 area + rounding", "mm2"},
      {"compare_volume", "2e-5", "ratio"},
  }};

  static Spec decode(Reader& in) { return decode_groove_request(in); }
  static Result<Out> compute(const Spec& spec, const std::stop_token& stop) {
    return groove::groove(spec, stop);
  }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    return groove::verify(spec, out);
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    w.object("sections", [&](Writer& o) { encode_sections(out.sections, o); });
    w.object("curves", [&](Writer& o) {
      encode_curve("c1", out.sections, &groove::CurvePoints::c1, o);
      encode_curve("c2", out.sections, &groove::CurvePoints::c2, o);
      encode_curve("c3", out.sections, &groove::CurvePoints::c3, o);
      encode_curve("c4", out.sections, &groove::CurvePoints::c4, o);
    });
    w.field("filler_area_mm2", out.area);
    w.field("first_order", spec.area_in == groove::AreaIn::normal);
    w.field("least_area_mm2", out.least_area);
    w.field("height_min_mm", out.height_min);
    w.field("height_max_mm", out.height_max);
    w.field("filler_volume_mm3", out.filler_volume);
    w.field("weld_length_mm", out.weld_length);
    if (!out.compare) return;
    w.object("compare", [&](Writer& o) {
      o.field("height_mm", out.compare->height);
      o.column("filler_area_mm2", out.compare->filler_area);
      o.field("filler_volume_mm3", out.compare->filler_volume);
    });
  }

  static void encode_sections(const std::vector<GrooveSection>& all, Writer& o) {
    using S = const GrooveSection&;
    o.degrees_column("omega_deg", each(all, [](S s) { return s.omega.rad(); }));
    o.degrees_column("phi_deg", each(all, [](S s) { return s.phi.rad(); }));
    o.column("root_z_mm", each(all, [](S s) { return s.root_z; }));
    o.column("height_mm", each(all, [](S s) { return s.height; }));
    o.column("p1_x_mm", each(all, [](S s) { return s.p1.x(); }));
    o.column("p1_y_mm", each(all, [](S s) { return s.p1.y(); }));
    o.column("p2_x_mm", each(all, [](S s) { return s.p2.x(); }));
    o.column("p2_y_mm", each(all, [](S s) { return s.p2.y(); }));
    o.column("p3_x_mm", each(all, [](S s) { return s.p3.x(); }));
    o.column("p3_y_mm", each(all, [](S s) { return s.p3.y(); }));
    // 0 where the chord's section is a pair of lines and has no such axis
    o.column("ellipse_a_mm", each(all, [](S s) { return s.ellipse_a.value_or(0.0); }));
    o.column("area_a_mm2", each(all, [](S s) { return s.areas.a; }));
    o.column("area_b_mm2", each(all, [](S s) { return s.areas.b; }));
    o.column("area_c_mm2", each(all, [](S s) { return s.areas.c; }));
    o.column("area_d_mm2", each(all, [](S s) { return s.areas.d; }));
    o.column("area_e_mm2", each(all, [](S s) { return s.areas.e; }));
    o.degrees_column("twist_deg", each(all, [](S s) { return s.ruling.twist.rad(); }));
    o.degrees_column("groove_angle_deg", each(all, [](S s) { return s.groove_angle.rad(); }));
  }

  static void encode_curve(std::string_view name, const std::vector<GrooveSection>& all,
                           Eigen::Vector3d groove::CurvePoints::*curve, Writer& w) {
    w.object(name, [&](Writer& o) {
      o.column("x_mm", each(all, [&](const GrooveSection& s) { return (s.curves.*curve).x(); }));
      o.column("y_mm", each(all, [&](const GrooveSection& s) { return (s.curves.*curve).y(); }));
      o.column("z_mm", each(all, [&](const GrooveSection& s) { return (s.curves.*curve).z(); }));
    });
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &groove_csv},
        {"svg", "image/svg+xml", &groove_svg, {"chart", "section"}},
        {"glb", "model/gltf-binary", &groove_gltf}};
    return kFormats;
  }
};

}  // namespace

Endpoint grooves() { return endpoint<Grooves>(); }

}  // namespace tubecut::api
