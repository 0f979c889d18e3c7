#include "api/endpoint.hpp"
#include "api/endpoints/all.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::api {
namespace {

struct Intersections {
  using Spec = joint::IntersectionSpec;
  using Out = joint::Intersection;
  static constexpr std::string_view kId = "intersections";
  static constexpr std::string_view kPath = "/v1/intersections";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr std::array<CheckLimit, 4> kChecks{{
      {"on_cutter", "1e-12 max(radius + rho, |z|)", "mm"},
      {"none_above", "1e-9 max(radius + rho, |z|)", "mm"},
      {"event_gap", "1e-8 (radius + rho)", "mm"},
      {"labels", "1e-7 max(radius + rho, |z|)", "mm"},
  }};

  static Spec decode(Reader& in) {
    using joint::Surfaces;
    static constexpr std::array kSurfaces{Option<Surfaces>{"inner", Surfaces::inner},
                                          Option<Surfaces>{"outer", Surfaces::outer},
                                          Option<Surfaces>{"both", Surfaces::both}};
    Spec out;
    out.target = decode_target(in);
    out.partners = decode_cutters(in);
    out.surfaces = in.choice("surfaces", kSurfaces, Surfaces::both);
    out.sampling = decode_sampling(in);
    return out;
  }

  static Result<Out> compute(const Spec& spec, const std::stop_token& stop) {
    return joint::intersect(spec, stop);
  }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    return joint::verify(spec, out);
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    w.array("profiles", out.profiles, [&](Writer& each, const joint::Profile& p) {
      each.object([&](Writer& o) {
        o.field("surface", p.outer ? "outer" : "inner");
        o.field("radius_mm", p.radius);
        o.object("points", [&](Writer& c) {
          encode_phi(p.phi, spec.sampling, c);
          c.column("z_mm", p.z);
          c.column("cutter", p.cutter);
        });
        o.array("events", p.events, [&](Writer& e, const joint::Event& event) {
          encode_event(event, p.outer, e);
        });
        o.field("length_mm", p.length);
        o.field("developed_length_mm", p.developed);
      });
    });
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kNone;
    return kNone;
  }
};

}  // namespace

Endpoint intersections() { return endpoint<Intersections>(); }

}  // namespace tubecut::api
