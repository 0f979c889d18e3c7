// One generator of joints feeds the three endpoints that take centre-lines: of every kind, drawn
// from either end of either tube, with coordinates as programs write them. Each answer lies in the
// world on the stated surfaces, measured in long double from the request.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "tests/support/drawn_joints.hpp"

namespace tubecut::testing {
namespace {

using namespace drawn;  // NOLINT(google-build-using-namespace): points and their operators

constexpr Real kOnNode = 1e-7L;   // mm: a node's numbers are exact
constexpr Real kOnPart = 1e-4L;   // a frame's are written to 1e-6 mm and 1e-11 deg
constexpr Real kPasses = 0.009L;  // sine: nearly in line the plane is midway between the ends

void options(Json::Object& out) {
  out.emplace_back("root_surface", "inner");
  out.emplace_back("groove", *api::parse(R"({"rule": "none"})"));
  out.emplace_back("smoothing", *api::parse(R"({"method": "none"})"));
}
void once(Json::Object& out) {
  out.emplace_back("kerf_mm", Json{1.0});
  out.emplace_back("torch", *api::parse(R"({"min_deg": -88, "max_deg": 88})"));
}
void sampled(Json::Object& out) {
  out.emplace_back("sampling", *api::parse(R"({"tolerance_mm": 0.3})"));
}

Json nodes_request(const Model& model, Random& random) {
  auto out = members_of(model, random);
  out.emplace_back("include", *api::parse(R"(["profiles", "tables"])"));
  Json::Object tables;
  options(tables);
  once(tables);
  sampled(out);
  out.emplace_back("tables", Json{std::move(tables)});
  return Json{std::move(out)};
}

Json part_request(const Model& model, std::size_t tube, Random& random) {
  auto out = members_of(model, random);
  out.emplace_back("member", Json{model.tubes[tube].id});
  const Point along = model.tubes[tube].into(false);
  out.emplace_back("up", numbers_of(unit(cross(random.direction(), along))));
  Json::Array holes;
  for (const auto& said : model.joints)
    if (said.chord == tube && said.hole)
      holes.push_back(with(*api::parse(R"({"groove": {"rule": "none"}, "tilt": "free"})"), "member",
                           Json{model.tubes[said.branch].id}));
  if (!holes.empty()) out.emplace_back("holes", Json{std::move(holes)});
  options(out);
  once(out);
  sampled(out);
  return Json{std::move(out)};
}

Json frame_request(const Model& model, Random& random) {
  auto out = frame_of(model, random);
  Json::Object defaults;
  options(defaults);
  defaults.emplace_back("tilt", "free");
  out.emplace_back("defaults", Json{std::move(defaults)});
  once(out);
  sampled(out);
  return Json{std::move(out)};
}

/// A part, or an end, in the world.
struct Placed {
  Point origin, x, y, z;

  explicit Placed(const Json& frame) {
    const auto vector = [&](const char* name) {
      const auto v = numbers(frame, name);
      return Point{v[0], v[1], v[2]};
    };
    origin = vector("origin_mm");
    x = vector("x");
    y = vector("y");
    z = vector("z");
  }
  [[nodiscard]] Point at(Real radius, double deg, double along) const {
    const Real phi = static_cast<Real>(deg) * kTurn / 360;
    return origin + radius * std::cos(phi) * x + radius * std::sin(phi) * y +
           static_cast<Real>(along) * z;
  }
};

/// The worst of one joint by one endpoint: distance of its cuts from the statement.
struct Measured {
  const Model& model;
  Real off = 0;
  std::map<std::size_t, std::vector<Real>> heights = {};  // of a face's tube: along the normal

  [[nodiscard]] const Said& said() const { return model.joints.front(); }
  [[nodiscard]] const Tube& chord() const { return model.tubes[said().chord]; }
  [[nodiscard]] const Tube& branch() const { return model.tubes[said().branch]; }
  void see(Real one) { off = std::max(off, std::abs(one)); }

  /// A place of an end's root.
  void see_end(std::size_t tube, const Point& p) {
    const auto kind = said().kind;
    if (faces(kind))
      heights[tube].push_back(dot(p - chord().at(said().chord_end), normal()));
    else
      see(chord().off(p) -
          (kind == Kind::set_on ? chord().radius + said().gap : chord().radius - said().depth));
  }
  void see_hole(const Point& bore, const Point& face) {
    if (said().kind == Kind::set_on)
      return see(branch().off(face) - branch().radius + branch().wall);
    see(branch().off(bore) - branch().radius - said().gap);
    see(std::max(Real{0}, branch().radius + said().gap - branch().off(face)));
  }

  /// Of the plane between two that are mitred, towards the chord.
  [[nodiscard]] Point normal() const {
    const Point u = chord().into(said().chord_end), v = branch().into(said().branch_end);
    if (said().kind != Kind::corner_to_corner) return unit(u - v);
    // Through the corner, where the outlines on the outer side cross.
    const Point side = unit(cross(u, v));
    const Point m = cross(u, side), n = cross(side, v);
    const Point corner =
        chord().radius * m + ((branch().radius - chord().radius * dot(m, n)) / dot(u, n)) * u;
    const Point out = unit(cross(corner, side));
    return dot(out, u) > 0 ? out : Real{-1} * out;
  }
  /// Where it passes, along the normal, from the chord's end.
  [[nodiscard]] Real middle() const {
    const Point w = branch().at(said().branch_end) - chord().at(said().chord_end);
    const Point u = chord().into(said().chord_end), v = branch().into(said().branch_end);
    const Real c = dot(u, v), square = 1 - c * c;
    if (c < 0 && square < kPasses * kPasses) return dot(normal(), w) / 2;
    // The two places that are nearest to each other, by the normal equations.
    const Real s = (dot(u, w) - c * dot(v, w)) / square, t = (c * dot(u, w) - dot(v, w)) / square;
    return dot(normal(), w + s * u + t * v) / 2;
  }
  /// Once all is seen: both faces are planes, half the gap off the one between them.
  void close() {
    for (const auto& [tube, all] : heights)
      for (const Real height : all)
        see(height - middle() - (tube == said().chord ? 1 : -1) * said().gap / 2);
  }
};

void measure_node(const Json& answer, Measured& out) {
  for (const auto& end : *at(answer, "result/ends").as<Json::Array>()) {
    const Placed placed(at(end, "frame"));
    const std::size_t tube = text(end, "member") == out.model.tubes[0].id ? 0 : 1;
    for (const auto& curve : *at(end, "profiles").as<Json::Array>()) {
      const auto phi = numbers(curve, "points/phi_deg"), z = numbers(curve, "points/z_mm");
      const Real radius = number(curve, "radius_mm");
      for (std::size_t i = 0; i < phi.size(); ++i)
        out.see_end(tube, placed.at(radius, phi[i], z[i]));
    }
  }
  out.close();
}

/// Measures a part's answer, positioned in the world by `frame`.
void measure_part(const Json& part, const Json& frame, std::size_t tube, Measured& out) {
  const Placed placed(frame);
  const auto& own = out.model.tubes[tube];
  for (const bool last : {false, true}) {
    const auto& end = at(part, std::string("result/ends/") + (last ? "finish" : "start"));
    if (at(end, "cutter_ids").as<Json::Array>()->empty()) continue;
    const auto phi = numbers(end, "points/phi_deg"), z = numbers(end, "points/z_inner_mm");
    for (std::size_t i = 0; i < phi.size(); ++i)
      out.see_end(tube, placed.at(own.radius - own.wall, phi[i], z[i]));
  }
  for (const auto& hole : *at(part, "result/holes").as<Json::Array>()) {
    const auto phi_in = numbers(hole, "points/phi_inner_deg"),
               phi = numbers(hole, "points/phi_deg"), z_in = numbers(hole, "points/z_inner_mm"),
               z = numbers(hole, "points/z_mm");
    for (std::size_t i = 0; i < phi.size(); ++i)
      out.see_hole(placed.at(own.radius - own.wall, phi_in[i], z_in[i]),
                   placed.at(own.radius, phi[i], z[i]));
  }
}

bool is_ours(const Posted& answer) {
  return answer.outcome.error &&
         static_cast<int>(*answer.outcome.error) >= static_cast<int>(ErrorKind::overloaded);
}

/// Codes that a shop has to check; notes, as on the sampling, belong to each answer.
std::set<std::string> codes(const Json& answer) {
  std::set<std::string> out;
  for (const auto& one : *at(answer, "warnings").as<Json::Array>())
    if (text(one, "severity") == "cut") out.insert(text(one, "code"));
  return out;
}

/// Every reason has a pointer into the request.
void expect_inside(const Posted& answer, const Json& request) {
  const char* list = answer.outcome.error ? "errors" : "warnings";
  for (const auto& one : *at(answer.body, list).as<Json::Array>()) {
    EXPECT_TRUE(leads_into(request, text(one, "pointer"))) << api::dump(one);
    if (answer.outcome.error) {
      EXPECT_FALSE(text(one, "hint").empty()) << api::dump(one);
    }
  }
}

/// One member in the answer of frames: its part, or the code of the problem.
struct FramePart {
  const Json* answer = nullptr;
  const Json* frame = nullptr;
  std::string problem;
};
FramePart part_of(const Json& frames, const std::string& id) {
  FramePart out;
  std::string name;
  for (const auto& one : *at(frames, "result/members").as<Json::Array>())
    if (text(one, "id") == id) {
      name = text(one, "part");
      out.frame = one.find("frame");
    }
  for (const auto& one : *at(frames, "parts").as<Json::Array>()) {
    if (text(one, "part") != name) continue;
    out.answer = one.find("answer");
    if (const auto* problem = one.find("problem")) {
      out.problem = text(*problem, "code");
      for (const auto& issue : *at(*problem, "errors").as<Json::Array>())
        EXPECT_TRUE(leads_into(at(one, "request"), text(issue, "pointer"))) << api::dump(issue);
    }
  }
  return out;
}

struct Tally {
  Real node = 0, part = 0, frame = 0;
  int parts = 0, refused = 0;
  std::map<std::string, int> why;
};

std::string told(Kind kind, Written written, std::size_t ends) {
  return word(kind, true) + (kind == Kind::corner_to_corner ? " corner" : "") + ", written " +
         std::to_string(static_cast<int>(written)) + ", ends " + std::to_string(ends);
}

/// Sends one model to the three endpoints; their results for each tube are the same.
void ask(const Model& model, Random& random, Tally& tally) {
  const auto nodes = nodes_request(model, random);
  const auto of_nodes = post("/v1/nodes", nodes);
  ASSERT_FALSE(of_nodes.outcome.error) << of_nodes.outcome.body << api::dump(nodes);
  expect_inside(of_nodes, nodes);
  Measured node{model};
  measure_node(of_nodes.body, node);
  tally.node = std::max(tally.node, node.off);

  const auto frames = frame_request(model, random);
  const auto of_frames = post("/v1/frames", frames);
  ASSERT_FALSE(of_frames.outcome.error) << of_frames.outcome.body << api::dump(frames);
  expect_inside(of_frames, frames);
  Measured part{model}, frame{model};
  for (std::size_t i = 0; i < model.tubes.size(); ++i) {
    const auto request = part_request(model, i, random);
    const auto of_part = post("/v1/parts", request);
    ASSERT_FALSE(is_ours(of_part)) << of_part.outcome.body << api::dump(request);
    expect_inside(of_part, request);
    const auto in_frame = part_of(of_frames.body, model.tubes[i].id);
    if (of_part.outcome.error) {
      EXPECT_EQ(text(of_part.body, "code"), in_frame.problem) << of_part.outcome.body;
      ++tally.refused;
      ++tally.why[text(of_part.body, "code")];
      continue;
    }
    ++tally.parts;
    measure_part(of_part.body, at(of_part.body, "result/frame"), i, part);
    ASSERT_TRUE(in_frame.answer) << in_frame.problem << api::dump(request);
    measure_part(*in_frame.answer, *in_frame.frame, i, frame);
    EXPECT_EQ(text(of_part.body, "verdict/status") == "reject",
              text(of_frames.body, "verdict/status") == "reject");
    // Warnings of the single part are also in the frame.
    const auto alone = codes(of_part.body), beside = codes(of_frames.body);
    EXPECT_TRUE(std::ranges::includes(beside, alone))
        << api::dump(at(of_part.body, "warnings")) << api::dump(at(of_frames.body, "warnings"));
  }
  part.close();
  frame.close();
  tally.part = std::max(tally.part, part.off);
  tally.frame = std::max(tally.frame, frame.off);
}

class EveryJoint : public ::testing::TestWithParam<Kind> {};

TEST_P(EveryJoint, IsOneThingToNodesPartsAndFrames) {
  Random random(20260901 + static_cast<std::uint64_t>(GetParam()));
  Tally tally;
  int asked = 0;
  const int times = GetParam() == Kind::set_in || GetParam() == Kind::through ? 1 : 2;  // holes
  for (const auto written : kWritten)
    for (std::size_t ends = 0; ends < 4; ++ends)
      for (int again = 0; again < times; ++again, ++asked) {
        auto model = pair(random, GetParam(), ends);
        write_down(model, written, random);
        SCOPED_TRACE(told(GetParam(), written, ends));
        ask(model, random, tally);
        if (HasFatalFailure()) return;
      }
  std::printf("%d joints, %d parts, %d refused; off by %.2Lg, %.2Lg, %.2Lg mm\n", asked,
              tally.parts, tally.refused, tally.node, tally.part, tally.frame);
  for (const auto& [code, count] : tally.why) std::printf("  %s %d\n", code.c_str(), count);
  EXPECT_LT(tally.node, kOnNode);
  EXPECT_LT(tally.part, kOnNode);
  EXPECT_LT(tally.frame, kOnPart);
  EXPECT_LE(20 * tally.refused, tally.parts);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, EveryJoint, ::testing::ValuesIn(kKinds));

// A camber drawn with rounded coordinates: its faces lie where the pieces end, not metres away
// where their axes happen to cross.
TEST(EveryJoint, CamberedPiecesMeetAtTheirEnds) {
  Random random(20260915);
  Real furthest = 0;
  for (std::size_t n = 0; n < 245; ++n) {
    auto model = pair(random, Kind::butt, random.upto(3));
    const auto& said = model.joints.front();
    auto& branch = model.tubes[said.branch];
    const Point lean =
        random.leaning(model.tubes[said.chord].into(said.chord_end), random.between(175, 179.95L));
    (said.branch_end ? branch.start : branch.finish) =
        branch.at(said.branch_end) + random.between(900, 2000) * lean;
    write_down(model, kWritten[n % kWritten.size()], random);
    auto request = members_of(model, random);
    request.emplace_back("include", *api::parse(R"(["profiles"])"));
    request.emplace_back("sampling", *api::parse(R"({"uniform_points": 12})"));
    const auto answer = post("/v1/nodes", Json{std::move(request)});
    ASSERT_FALSE(answer.outcome.error) << n << answer.outcome.body;
    const Real apart = norm(model.tubes[1].at(said.branch_end) - model.tubes[0].at(said.chord_end));
    for (const auto& end : *at(answer.body, "result/ends").as<Json::Array>())
      for (const auto& curve : *at(end, "profiles").as<Json::Array>())
        for (const Real z : numbers(curve, "points/z_mm"))
          furthest = std::max(furthest, (std::abs(z) - apart - said.gap) / model.tubes[0].radius);
  }
  std::printf("faces at most %.3Lf radii further from the ends than these are apart\n", furthest);
  EXPECT_GT(furthest, 0);
  EXPECT_LT(furthest, 1.06L);
}

TEST(EveryJoint, MitreWhoseMembersBothStartThere) {
  const auto answer =
      post("/v1/nodes",
           *api::parse(read_project_file("tests/field/mitre-both-start-at-the-joint.nodes.json")));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body;
  for (const auto& one : *at(answer.body, "verification/checks").as<Json::Array>())
    EXPECT_LE(number(one, "value"), number(one, "limit")) << api::dump(one);
}

}  // namespace
}  // namespace tubecut::testing
