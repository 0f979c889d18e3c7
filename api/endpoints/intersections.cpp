#include "api/endpoints/all.hpp"
#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/work.hpp"
#include "api/formats/drawing/partner_names.hpp"
#include "api/formats/intersection_formats.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/joint_names.hpp"
#include "core/base/try.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::api {
namespace {

struct IntersectionRequest : joint::IntersectionSpec {
  JointSource source;
};

struct Intersections {
  using Spec = IntersectionRequest;
  using Out = joint::Intersection;
  static constexpr std::string_view kId = "intersections";
  static constexpr std::string_view kPath = "/v1/intersections";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr double kBudgetS = api::kBudgetS;
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr auto kChecks = kProfileChecks;

  static Spec decode(Reader& in) {
    Spec out;
    out.source = decode_joint(in);
    out.surfaces = in.choice("surfaces", joint::Surfaces::both);
    out.sampling = decode_sampling(in);
    return out;
  }

  static Result<Spec> resolve(Spec spec, const std::stop_token& stop) {
    TRY(auto source, api::resolve(std::move(spec.source), stop));
    spec.source = std::move(source);
    spec.target = spec.source.target;
    spec.partners = spec.source.node ? joint::seats(spec.source.found) : spec.source.partners;
    return spec;
  }
  static void count(const Spec& spec, Work& work) { add_work(spec, work); }
  static Result<Out> compute(const Spec& spec, const std::stop_token& stop) {
    return on_node(spec.source, joint::intersect(spec, stop));
  }
  static std::vector<Check> verify(const Spec& spec, const Out& out, const std::stop_token& stop) {
    return joint::verify(spec, out, stop);
  }
  static std::vector<Warning> warnings(const Spec& spec, const Out& out) {
    return on_node(spec.source, out.warnings);
  }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    w.array("profiles", out.profiles, [&](Writer& each, const joint::Profile& p) {
      each.object([&](Writer& o) { encode_profile(p, spec.sampling, o); });
    });
    if (spec.source.node) w.column("cutter_ids", cutter_ids(spec.source));
  }

  template <auto Print>
  static std::string print(const Spec& spec, const Out& out, const Caption& caption) {
    auto named = caption;
    named.partners = partner_names(caption.request, cutter_ids(spec.source), spec.partners.size());
    return Print(spec, out, named);
  }
  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &print<intersection_csv>},
        {"svg",
         "image/svg+xml",
         &print<intersection_svg>,
         {"chart", "template", "section"},
         {"mirror", "paper"}},
        {"pdf",
         "application/pdf",
         &print<intersection_pdf>,
         {"template", "section"},
         {"mirror", "paper"}},
        {"dxf", "image/vnd.dxf", &print<intersection_dxf>, {"template", "tube"}}};
    return kFormats;
  }
};

}  // namespace

Endpoint intersections() { return endpoint<Intersections>(); }

}  // namespace tubecut::api
