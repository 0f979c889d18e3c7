#include "api/endpoints/all.hpp"
#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/section_target.hpp"
#include "api/formats/drawing/partner_names.hpp"
#include "api/formats/intersection_formats.hpp"
#include "api/formats/section_formats.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/joint_names.hpp"
#include "api/wire/section_tables.hpp"
#include "core/base/try.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/node/end_curves.hpp"

namespace tubecut::api {
namespace {

struct IntersectionRequest : joint::IntersectionSpec {
  JointSource source;
  std::optional<SectionTarget> section = {};  // of a target that is not round
};

std::optional<section::Section> outline_of(const IntersectionRequest& spec) {
  if (!spec.section) return std::nullopt;
  return spec.section->section;
}

struct Intersections {
  using Spec = IntersectionRequest;
  using Out = joint::EndCurves;
  static constexpr std::string_view kId = "intersections";
  static constexpr std::string_view kPath = "/v1/intersections";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr double kBudgetS = api::kBudgetS;
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr auto kChecks =
      joined(kProfileChecks,
             std::array<CheckLimit, 1>{{{"on_section", "1e-12 of the section's reach", "mm"}}});

  static Spec decode(Reader& in) {
    Spec out;
    if (has_section_target(in)) {
      in.exactly_one({"target", "node"});
      out.section = decode_section_target(in);
      out.source.target = target_of(*out.section);
      out.source.partners = decode_cutters(in);
    } else {
      out.source = decode_joint(in, Targets::any);
      if (out.source.node) out.section = out.source.node->section;
    }
    out.surfaces = in.choice("surfaces", joint::Surfaces::both);
    out.sampling = decode_sampling(in);
    return out;
  }

  static Result<Spec> resolve(Spec spec) {
    TRY(auto source, api::resolve(std::move(spec.source)));
    spec.source = std::move(source);
    spec.target = spec.source.target;
    spec.partners = spec.source.node ? joint::seats(spec.source.found) : spec.source.partners;
    return spec;
  }
  static Result<Out> compute(const Spec& spec) {
    return on_node(spec.source, joint::curves(spec, outline_of(spec)));
  }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    return joint::verify(spec, outline_of(spec), out);
  }
  static std::vector<Warning> warnings(const Spec& spec, const Out& out) {
    return on_node(spec.source, out.warnings);
  }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    if (spec.section) {
      encode_section(*spec.section, w);
      w.array("profiles", out.of_section->profiles,
              [](Writer& each, const joint::SectionProfile& p) {
                each.object([&](Writer& o) { encode_profile(p, o); });
              });
    } else {
      w.array("profiles", out.profiles, [&](Writer& each, const joint::Profile& p) {
        each.object([&](Writer& o) { encode_profile(p, spec.sampling, o); });
      });
    }
    if (spec.source.node) w.column("cutter_ids", cutter_ids(spec.source));
  }

  static std::string print_csv(const Spec& spec, const Out& out, const Caption& caption) {
    if (spec.section) return section_csv(*out.of_section, caption);
    return intersection_csv(spec, out, caption);
  }
  template <auto Print, auto PrintSection>
  static std::string print(const Spec& spec, const Out& out, const Caption& caption) {
    auto named = caption;
    named.partners = partner_names(caption.request, cutter_ids(spec.source), spec.partners.size());
    if (!spec.section) return Print(spec, out, named);
    refuse_section_view(caption);
    return PrintSection(spec.section->section, *out.of_section, named);
  }
  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &print_csv},
        {"svg",
         "image/svg+xml",
         &print<intersection_svg, section_svg>,
         {"chart", "template", "section"},
         {"mirror", "paper"}},
        {"pdf",
         "application/pdf",
         &print<intersection_pdf, section_pdf>,
         {"template", "section"},
         {"mirror", "paper"}},
        {"dxf", "image/vnd.dxf", &print<intersection_dxf, section_dxf>, {"template", "tube"}}};
    return kFormats;
  }
};

}  // namespace

Endpoint intersections() { return endpoint<Intersections>(); }

}  // namespace tubecut::api
