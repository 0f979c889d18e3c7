#include "api/endpoint.hpp"
#include "api/endpoints/all.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/node_codec.hpp"
#include "core/joint/node.hpp"

namespace tubecut::api {
namespace {

struct NodesRequest {
  joint::NodeSpec node;
  bool profiles = false;
  joint::Sampling sampling;
};
struct NodesAnswer {
  joint::Nodes nodes;
  std::vector<std::optional<joint::Intersection>> profiles;  // of each end, if asked for
};

bool decode_include(Reader& in) {
  in.note("include");
  if (!in.has("include")) return false;
  const auto parts = in.text_column("include", {.min = 1, .max = 1});
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!parts[i].empty() && parts[i] != "profiles")
      in.issue({.code = ErrorCode::bad_choice,
                .pointer = "include/" + std::to_string(i),
                .got = Json{parts[i]},
                .limit = Json{"profiles"}});
  return !parts.empty();
}

std::vector<double> components(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

void encode_cut(const joint::NodeSpec& spec, const joint::CutBy& cut, Writer& w) {
  const auto& tube = cut.placement.tube;
  w.field("member", spec.members[cut.member].name);
  w.object("placement", [&](Writer& p) {
    p.degrees("inclination_deg", tube.inclination.rad());
    p.degrees("clocking_deg", tube.clocking.rad());
    p.field("offset_mm", tube.offset);
    p.field("height_mm", tube.height);
  });
  w.field("gap_mm", cut.gap);
  w.field("eccentricity_mm", cut.eccentricity);
  w.field("ghost", cut.ghost);
}

void encode_frame(const joint::MemberFrame& frame, Writer& w) {
  w.column("origin_mm", components(frame.origin));
  w.column("x", components(frame.rows.row(0)));
  w.column("y", components(frame.rows.row(1)));
  w.column("z", components(frame.rows.row(2)));
}

struct Nodes {
  using Spec = NodesRequest;
  using Out = NodesAnswer;
  static constexpr std::string_view kId = "nodes";
  static constexpr std::string_view kPath = "/v1/nodes";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_large_max_bytes);
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr std::array<CheckLimit, 6> kChecks{{
      {"axis_in_world", "1e-12, of the lengths involved", ""},
      {"inclination", "1e-9", "deg"},
      {"eccentricity", "1e-12, of the lengths involved", ""},
      {"gap", "1e-12, of the lengths involved", ""},
      {"frame", "1e-12", ""},
      {"one_cuts_the_other", "0", ""},
  }};

  static Spec decode(Reader& in) {
    Spec out;
    out.node = decode_node(in);
    out.profiles = decode_include(in);
    out.sampling = decode_sampling(in);
    return out;
  }

  static Result<Out> compute(const Spec& spec, const std::stop_token& stop) {
    auto nodes = joint::solve(spec.node, stop);
    if (!nodes) return tl::unexpected(nodes.error());
    Out out{.nodes = *std::move(nodes), .profiles = {}};
    if (!spec.profiles) return out;
    auto profiles = joint::profiles(spec.node, out.nodes, spec.sampling, stop);
    if (!profiles) return tl::unexpected(profiles.error());
    out.profiles = *std::move(profiles);
    return out;
  }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    return joint::verify(spec.node, out.nodes);
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.nodes.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode_end(const Spec& spec, const Out& out, const joint::MemberEnd& end, Writer& w) {
    const bool start = end.end == joint::End::start;
    w.field("member", spec.node.members[end.member].name);
    w.field("end", start ? "start" : "finish");
    w.array("cut_by", end.cut_by, [&](Writer& each, const joint::CutBy& cut) {
      each.object([&](Writer& o) { encode_cut(spec.node, cut, o); });
    });
    w.object("frame", [&](Writer& o) { encode_frame(end.frame, o); });
    w.field("free", end.free);
    w.field("open", end.open);
    w.field("consumed", end.consumed);
    const auto index = 2 * end.member + (start ? 0U : 1U);
    static const std::vector<joint::Profile> kNone;
    const bool there = index < out.profiles.size() && out.profiles[index];
    w.array("profiles", there ? out.profiles[index]->profiles : kNone,
            [&](Writer& each, const joint::Profile& profile) {
              each.object([&](Writer& o) { encode_profile(profile, spec.sampling, o); });
            });
  }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    w.array("ends", out.nodes.ends, [&](Writer& each, const joint::MemberEnd& end) {
      each.object([&](Writer& o) { encode_end(spec, out, end, o); });
    });
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kNone;
    return kNone;
  }
};

}  // namespace

Endpoint nodes() { return endpoint<Nodes>(); }

}  // namespace tubecut::api
