// Whole frames with every kind of joint, drawn from either end of each tube and written with
// coordinates rounded to 0.01 to 1 mm: each is answered, each reason has a pointer into the
// request, and there is a part for every member that rays in long double find cuttable.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "tests/support/drawn_joints.hpp"

namespace tubecut::testing {
namespace {

using namespace drawn;  // NOLINT(google-build-using-namespace): points and their operators

/// A frame as it grows: a chord with branches at stations along it, tubes that go on from free ends
/// round a corner or in line, supports on bends, feet on plates.
class Grown {
 public:
  explicit Grown(std::uint64_t seed) : random_(seed) {
    Tube chord{.id = "chord"};
    chord.radius = random_.between(60, 220);
    chord.wall = chord.radius * random_.between(0.05L, 0.12L);
    axis_ = unit({random_.between(-1, 1), random_.between(-1, 1), random_.between(-0.2L, 0.2L)});
    const Real step = random_.between(6, 8) * chord.radius;
    const std::size_t stations = 2 + random_.upto(2);
    chord.finish = static_cast<Real>(stations + 1) * step * axis_;
    add(chord);
    for (std::size_t k = 1; k <= stations; ++k) add_branch(static_cast<Real>(k) * step);
    go_on(0, false, random_.coin() ? Kind::mitre : Kind::corner_to_corner);
    if (random_.coin()) go_on(0, true, Kind::butt);
    add_support();
    turn_round();
    written_ = kWritten[4 + random_.upto(2)];
    write_down(model_, written_, random_);
  }

  [[nodiscard]] Json request() {
    if (random_.coin() && alone_within(15)) model_.within = 15;
    auto out = frame_of(model_, random_);
    Json::Array others;
    auto& joints = *find(out, "joints").as<Json::Array>();
    for (const auto& one : others_) {
      others.push_back(one.json(model_.tubes[one.tube]));
      joints.emplace_back(*api::parse(R"({"between": [")" + model_.tubes[one.tube].id + R"(", ")" +
                                      one.id + R"("], "kind": "set_on", "end": ")" +
                                      (one.last ? "finish" : "start") + R"("})"));
    }
    out.emplace_back("others", Json{std::move(others)});
    out.emplace_back("defaults", *api::parse(R"({"root_surface": "inner", "tilt": "free",
        "groove": {"rule": "none"}, "smoothing": {"method": "none"}})"));
    out.emplace_back("kerf_mm", Json{1.5});
    out.emplace_back("torch", *api::parse(R"({"min_deg": -88, "max_deg": 88})"));
    out.emplace_back("sampling", *api::parse(R"({"tolerance_mm": 0.3})"));
    return Json{std::move(out)};
  }
  [[nodiscard]] const Model& model() const { return model_; }

 private:
  /// A plate or a bend at the end of a tube; placed where the tube is once that is written.
  struct Other {
    std::string id;
    std::size_t tube;
    bool last, bend;
    Point side{};
    Real radius = 0, bend_radius = 0;

    [[nodiscard]] Json json(const Tube& t) const {
      const Point along = t.into(last);
      Json::Object out{{"id", Json{id}}, {"kind", Json{bend ? "elbow" : "plane"}}};
      if (!bend) {
        out.emplace_back("point_mm", numbers_of(t.at(last)));
        out.emplace_back("normal", numbers_of(unit(along + Real{0.4L} * side)));
        return Json{std::move(out)};
      }
      // Its run goes down along the intended tube; the tube has its written ends.
      out.emplace_back("outer_diameter_mm", number_of(2 * radius));
      out.emplace_back("bend_radius_mm", number_of(bend_radius));
      out.emplace_back("bend_deg", Json{90.0});
      out.emplace_back("axis", Json{Json::Object{{"point_mm", numbers_of(t.at(last))},
                                                 {"direction", numbers_of(run)}}});
      out.emplace_back("inwards", numbers_of(side));
      return Json{std::move(out)};
    }
    Point run{};
  };

  static Json& find(Json::Object& object, std::string_view name) {
    for (auto& [key, value] : object)
      if (key == name) return value;
    std::abort();
  }

  std::size_t add(Tube tube) {
    tube.priority = static_cast<int>(model_.tubes.size());
    if (tube.id.empty()) tube.id = "T" + std::to_string(tube.priority);
    model_.tubes.push_back(std::move(tube));
    return model_.tubes.size() - 1;
  }

  void add_branch(Real along) {
    static constexpr std::array kOn{Kind::set_on, Kind::set_in, Kind::through};
    const auto kind = kOn[random_.upto(2)];
    const auto& chord = model_.tubes[0];
    auto tube = standing(random_, chord, along * axis_, axis_, kind, 75);
    tube.id.clear();
    Said said{.chord = 0, .kind = kind};
    said.gap = random_.coin() ? 0 : random_.between(0.2L, 2);
    said.depth = chord.wall * random_.between(0.6L, 1.2L);
    said.hole = kind != Kind::set_on || random_.coin();
    said.branch = add(tube);
    model_.joints.push_back(said);
    const auto branch = said.branch;
    const auto more = random_.upto(4);
    if (more == 0) go_on(branch, true, Kind::mitre);
    if (more == 1) go_on(branch, true, Kind::corner_to_corner);
    if (more == 2) go_on(branch, true, Kind::butt);
    if (more == 3) add_plate(branch);
  }

  /// Another tube at a free end; it leads away from the chord.
  void go_on(std::size_t from, bool last, Kind kind) {
    const Tube one = model_.tubes[from];
    const Point out = one.into(last);
    Tube next = one;
    next.id.clear();
    const Point away =
        kind == Kind::butt ? Real{-1} * out : random_.leaning(out, random_.between(100, 160));
    if (kind == Kind::corner_to_corner) next.radius *= random_.between(0.6L, 0.95L);
    next.wall = std::min(next.wall, next.radius / 4);
    next.start = one.at(last);
    next.finish = next.start + random_.between(8, 14) * one.radius * away;
    Said said{.branch = add(next), .chord = from, .kind = kind, .chord_end = last};
    said.gap = random_.coin() ? 0 : random_.between(0.5L, 2);
    model_.joints.push_back(said);
  }

  void add_plate(std::size_t tube) {
    others_.push_back({.id = "plate " + std::to_string(tube),
                       .tube = tube,
                       .last = true,
                       .bend = false,
                       .side = unit(cross(random_.direction(), model_.tubes[tube].into(true)))});
  }

  /// Adds a leg on a bend, along its run, at a random offset.
  void add_support() {
    Tube leg;
    leg.radius = random_.between(20, 60);
    leg.wall = leg.radius * random_.between(0.08L, 0.2L);
    leg.start = Point{0, 0, -6000};
    const Point up = random_.direction();
    const Real radius = leg.radius * random_.between(1.3L, 2.5L);
    const Real bend_radius = radius * random_.between(1.5L, 3);
    leg.finish = leg.start + (radius + bend_radius + random_.between(100, 500)) * up;
    Other bend{.id = "bend", .tube = add(leg), .last = false, .bend = true};
    bend.radius = radius;
    bend.bend_radius = bend_radius;
    bend.run = up;
    bend.side = unit(cross(random_.direction(), up));
    others_.push_back(bend);
  }

  /// Half of the tubes drawn the other way round.
  void turn_round() {
    for (std::size_t i = 0; i < model_.tubes.size(); ++i) {
      if (random_.coin()) continue;
      std::swap(model_.tubes[i].start, model_.tubes[i].finish);
      for (auto& said : model_.joints) {
        if (said.branch == i) said.branch_end = !said.branch_end;
        if (said.chord == i) said.chord_end = !said.chord_end;
      }
      for (auto& one : others_)
        if (one.tube == i) one.last = !one.last;
    }
  }

  /// No end is near a tube that it is not joined with.
  [[nodiscard]] bool alone_within(Real distance) const {
    const auto& tubes = model_.tubes;
    for (std::size_t i = 0; i < tubes.size(); ++i)
      for (std::size_t j = 0; j < tubes.size(); ++j) {
        const bool joined = std::ranges::any_of(model_.joints, [&](const Said& said) {
          return (said.branch == i && said.chord == j) || (said.branch == j && said.chord == i);
        });
        if (i == j || joined) continue;
        const Point along = tubes[j].finish - tubes[j].start;
        for (const bool last : {false, true}) {
          const Point from = tubes[i].at(last) - tubes[j].start;
          const Real share = std::clamp(dot(from, along) / dot(along, along), Real{0}, Real{1});
          if (norm(from - share * along) < distance + tubes[j].radius + 5) return false;
        }
      }
    return true;
  }

  Random random_;
  Point axis_{};
  Model model_;
  std::vector<Other> others_;
  Written written_{};
};

/// The highest place of a cylinder on a generator, from the end into the tube; NaN where it misses.
Real top(const Tube& tube, bool last, Real radius, Real phi, const Tube& by) {
  const Point z = tube.into(last),
              x = unit(cross(z, std::abs(z[0]) < 0.8L ? Point{1, 0, 0} : Point{0, 1, 0}));
  const Point p = tube.at(last) + radius * std::cos(phi) * x + radius * std::sin(phi) * cross(z, x);
  const Point d = unit(by.finish - by.start);
  const Point across = z - dot(z, d) * d, from = (p - by.start) - dot(p - by.start, d) * d;
  const Real a = dot(across, across), b = dot(across, from),
             c = dot(from, from) - by.radius * by.radius;
  return (-b + std::sqrt(b * b - a * c)) / a;
}

/// Returns whether the end of a branch can be cut to fit its chord: every generator of its wall
/// meets it, within the tube, and no line of the cut tilts by more than 80 deg.
bool cuttable(const Tube& branch, bool last, const Tube& chord) {
  const Real length = norm(branch.finish - branch.start);
  for (int k = 0; k < 72; ++k) {
    const Real phi = kTurn * k / 72;
    const Real inner = top(branch, last, branch.radius - branch.wall, phi, chord);
    const Real outer = top(branch, last, branch.radius, phi, chord);
    if (!(std::abs(outer - inner) < branch.wall * std::tan(80 * kTurn / 360))) return false;
    if (!(std::max(inner, outer) < length)) return false;
  }
  return true;
}

TEST(RandomFrames, HaveEveryPartThatCanBeCut) {
  const char* asked = std::getenv("TUBECUT_FRAMES");  // NOLINT(concurrency-mt-unsafe)
  const int count = asked == nullptr ? 60 : std::atoi(asked);
  int members = 0, parts = 0, within = 0;
  for (int n = 0; n < count; ++n) {
    Grown grown(20260911 + static_cast<std::uint64_t>(n));
    const auto request = grown.request();
    within += request.find("connect") != nullptr ? 1 : 0;
    const auto answer = post("/v1/frames", request);
    ASSERT_FALSE(answer.outcome.error) << n << answer.outcome.body << api::dump(request);
    for (const auto& one : *at(answer.body, "warnings").as<Json::Array>())
      EXPECT_TRUE(leads_into(request, text(one, "pointer"))) << n << api::dump(one);
    const auto& model = grown.model();
    for (const auto& said : model.joints) {
      if (said.kind == Kind::set_on || said.kind == Kind::set_in) {
        EXPECT_TRUE(cuttable(model.tubes[said.branch], said.branch_end, model.tubes[said.chord]))
            << n;
      }
    }
    members += static_cast<int>(model.tubes.size());
    for (const auto& part : *at(answer.body, "parts").as<Json::Array>()) {
      const auto* problem = part.find("problem");
      EXPECT_EQ(problem, nullptr) << n << api::dump(*problem) << api::dump(request);
      if (problem == nullptr) continue;
      for (const auto& issue : *at(*problem, "errors").as<Json::Array>())
        EXPECT_TRUE(leads_into(at(part, "request"), text(issue, "pointer"))) << api::dump(issue);
    }
    parts += static_cast<int>(number(answer.body, "result/totals/made"));
  }
  std::printf("%d frames, %d with connect, %d of %d members made\n", count, within, parts, members);
  EXPECT_EQ(parts, members);
  EXPECT_GT(members, 6 * count);
}

}  // namespace
}  // namespace tubecut::testing
