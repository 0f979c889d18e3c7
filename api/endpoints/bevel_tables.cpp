#include <algorithm>
#include <cmath>
#include <utility>

#include "api/endpoints/all.hpp"
#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/section_bevel_table.hpp"
#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/drawing/partner_names.hpp"
#include "api/formats/gcode/gcode.hpp"
#include "api/formats/section_formats.hpp"
#include "api/formats/step/step.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "core/base/try.hpp"
#include "core/bevel/beam/beam.hpp"
#include "core/bevel/section/section_table.hpp"
#include "core/bevel/table/table.hpp"

namespace tubecut::api {
namespace {

static_assert(limit::kerf_pairs_max == bevel::kMostKerfPairs);

struct BevelTables {
  struct Spec : BevelTableRequest {
    std::optional<SectionTarget> section = {};  // of a target that is not round
  };
  /// The table of a round target, or of a section.
  struct Out : bevel::Table {
    std::optional<EndReport> laser = {};
    std::optional<bevel::SectionTable> of_section = {};
  };
  static constexpr std::string_view kId = "bevel-tables";
  static constexpr std::string_view kPath = "/v1/bevel-tables";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr double kBudgetS = api::kBudgetS;
  static constexpr auto kAccepts =
      joined(std::array<std::string_view, 3>{"max_root_gap_mm", "max_extra_bevel_deg", "max_b_deg"},
             kEndAccepts);
  static constexpr auto kChecks =
      joined(kTableChecks, std::array<CheckLimit, 1>{{{"on_section", "1e-9", "mm"}}});

  static Spec decode(Reader& in) {
    if (!cuts_section(in)) return {decode_bevel_table_request(in)};
    auto out = decode_section_cut_request(in);
    return {std::move(out.table), std::move(out.section)};
  }

  static Result<Spec> resolve(Spec spec) {
    const auto section = spec.section;
    TRY(auto resolved, api::resolve(BevelTableRequest(std::move(spec))));
    return Spec{std::move(resolved), section};
  }
  static Result<Out> compute(const Spec& spec) {
    if (spec.section) {
      TRY(auto table, on_node(spec.source, bevel::section_table(spec.section->section, spec)));
      Out out;
      out.of_section = std::move(table);
      return out;
    }
    TRY(auto table, on_node(spec.source, bevel::table(spec)));
    Out out{std::move(table)};
    if (spec.preset == Preset::tube_laser) out.laser = end_report(spec, out, false);
    return out;
  }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    if (spec.section) return bevel::verify(spec.section->section, spec, *out.of_section);
    return bevel::verify(spec, out);
  }
  static std::vector<Warning> warnings(const Spec& spec, const Out& out) {
    return on_node(spec.source, out.of_section ? out.of_section->warnings : out.warnings);
  }

  static std::vector<Measure> measure(const Spec& spec, const Out& out) {
    if (out.of_section) return measures_of(spec, *out.of_section);
    double gap = 0.0, extra = 0.0, b = 0.0;
    for (std::size_t i = 0; i < out.b.size(); ++i) {
      gap = std::max(gap, out.gap[i]);
      extra = std::max(extra, out.b[i] - out.b_raw[i]);
      b = std::max(b, std::abs(out.b[i]));
    }
    std::vector<Measure> all{{"max_root_gap_mm", gap},
                             {"max_extra_bevel_deg", extra * kDegPerRad},
                             {"max_b_deg", b * kDegPerRad}};
    if (out.laser)
      for (const auto& one : measures_of(out, *out.laser)) all.push_back(one);
    return all;
  }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    if (spec.section) {
      encode_section(*spec.section, w);
      encode_table(spec, *out.of_section, spec.columns, w);
    } else {
      encode_table(spec, out, spec.columns, w);
    }
    if (spec.source.node) w.column("cutter_ids", cutter_ids(spec.source));
    if (out.laser) encode_end_report(out, *out.laser, w);
  }

  static std::string print_csv(const Spec& spec, const Out& out, const Caption& caption) {
    if (spec.section) return section_bevel_csv(spec, *out.of_section, spec.columns, caption);
    return bevel_table_csv(spec, out, spec.columns, caption);
  }
  /// `PrintSection`: nullptr if the format prints round targets only.
  template <auto Print, auto PrintSection = nullptr>
  static std::string print(const Spec& spec, const Out& out, const Caption& caption) {
    auto named = caption;
    named.partners = partner_names(caption.request, cutter_ids(spec.source), spec.partners.size());
    if (!spec.section) return Print(spec, out, named);
    if constexpr (std::is_null_pointer_v<decltype(PrintSection)>) {
      throw no_format_of_section("csv, svg, pdf, dxf, stl, glb and gcode");
    } else {
      refuse_section_view(caption);
      return PrintSection({spec.section->section, spec, *out.of_section}, named);
    }
  }
  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &print_csv},
        {"svg",
         "image/svg+xml",
         &print<bevel_table_svg, section_bevel_svg>,
         {"chart", "template", "section", "b_curve"},
         {"mirror", "paper"}},
        {"pdf",
         "application/pdf",
         &print<bevel_table_pdf, section_bevel_pdf>,
         {"template", "section"},
         {"mirror", "paper"}},
        {"dxf", "image/vnd.dxf", &print<bevel_table_dxf, section_bevel_dxf>, {"template", "tube"}},
        {"glb", "model/gltf-binary", &print<bevel_table_gltf, section_bevel_gltf>},
        {"stl", "model/stl", &print<bevel_table_stl, section_bevel_stl>, {"after", "before"}},
        {"step", "model/step", &print<bevel_table_step>, {"smooth", "straight"}},
        {"nc1", "application/x-dstv", &print<bevel_table_dstv>, {}, {}, false, true},
        {"gcode",
         "text/x-gcode",
         &print<bevel_table_gcode, section_bevel_gcode>,
         {},
         gcode_options(),
         true,
         true}};
    return kFormats;
  }
};

}  // namespace

BevelTableRequest decode_bevel_table_request(Reader& in) {
  BevelTableRequest out;
  out.preset = decode_preset(in);
  check_accepts(in, {.preset = out.preset});
  out.source = decode_joint(in);
  out.sampling = decode_sampling(in);
  decode_table_options(in, out.preset, out);
  out.columns = decode_table_columns(in, out);
  return out;
}

Result<BevelTableRequest> resolve(BevelTableRequest request) {
  TRY(auto source, resolve(std::move(request.source)));
  request.source = std::move(source);
  request.target = request.source.target;
  request.partners = request.source.partners;
  request.stated = request.source.stated;
  return request;
}

Endpoint bevel_tables() { return endpoint<BevelTables>(); }

}  // namespace tubecut::api
