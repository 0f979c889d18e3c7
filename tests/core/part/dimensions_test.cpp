#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "tests/core/part/measured_solid.hpp"
#include "tests/core/part/random_member.hpp"
#include "tests/support/cancelled.hpp"

namespace tubecut::testing {
namespace {

using part::Mistake;
using part::Part;
using part::PartSpec;

constexpr double kSeen = 1.0;  // mm

GivenPart given(const PartSpec& spec, const Part& p) {
  return {.outer = spec.target.outer_radius,
          .inner = spec.target.inner_radius(),
          .start_outer = {p.start.table.phi, p.start.table.z_outer},
          .start_inner = {p.start.table.phi, p.start.table.z_inner},
          .finish_outer = {p.finish.table.phi, p.finish.table.z_outer},
          .finish_inner = {p.finish.table.phi, p.finish.table.z_inner}};
}

/// Source 000's node: a tube of radius 35, wall 5, cut by four others; the far end square.
PartSpec table_1() {
  const auto tube = [](double radius, double alpha, double beta, double offset) {
    return joint::TubeCutter{.radius = radius,
                             .inclination = Angle::deg(alpha),
                             .clocking = Angle::deg(beta),
                             .offset = offset};
  };
  PartSpec out;
  out.target = {.outer_radius = 35, .wall = 5, .length = 500};
  bevel::TableSpec cut{.target = out.target};
  cut.partners = {tube(55, 85, 0, 0), tube(35, 65, 90, 15), tube(35, 35, 245, -5),
                  tube(35, 55, 320, 0)};
  cut.sampling = {.uniform_points = 360};
  cut.groove = bevel::HalfDihedral{};
  cut.smoothing =
      bevel::EnvelopeSmoothing{.limits = {.slope = 5 * kRadPerDeg, .curvature = 1 * kRadPerDeg}};
  out.finish = part::square_end(cut, 0.0);
  out.start.cut = cut;
  return out;
}

struct Made {
  PartSpec spec;
  Part part;
};

/// Table 1, and random members with both ends cut.
std::vector<Made> parts(std::size_t count, std::uint64_t seed) {
  std::vector<Made> out;
  const auto first = table_1();
  out.push_back({first, *part::part(first)});
  Random random{std::mt19937_64(seed)};
  while (out.size() < count) {
    auto spec = random_member(random);
    spec.cut.sampling = {.uniform_points = 180};
    if (random.upto(1) == 0) spec.cut.sampling = {.tolerance = joint::Tolerance{.value = 0.05}};
    const auto found = part::find_member(spec);
    if (!found) continue;
    auto made = part::part(found->part);
    if (made) out.push_back({found->part, *std::move(made)});
  }
  return out;
}

/// Off by less, whichever of equally long points the tape finds.
double off(const MeasuredSolid& solid, const part::CheckDimension& d) {
  const auto value = solid.measure(d.name);
  if (!value) return 1e300;
  double best = std::abs(*value - d.value);
  if (d.name.ends_with("_long_girth"))
    for (const double other : solid.long_girths(d.name.starts_with("finish")))
      best = std::min(best, std::abs(other - d.value));
  return best;
}

TEST(CheckDimensions, EqualMeasurementsOnTriangles) {
  double worst = 0;
  std::size_t count = 0;
  std::map<std::string, int> names;
  for (const auto& made : parts(40, 31)) {
    const auto& dims = made.part.check_dimensions;
    EXPECT_GE(dims.size(), 8u);
    EXPECT_LE(dims.size(), 12u);
    const MeasuredSolid solid(given(made.spec, made.part));
    for (const auto& d : dims) {
      const double here = off(solid, d);
      EXPECT_LE(here, 0.01) << d.name << " " << d.value;
      worst = std::max(worst, here);
      ++names[d.name];
      ++count;
    }
  }
  std::printf("%zu dimensions of %zu kinds, worst %.4g mm\n", count, names.size(), worst);
  EXPECT_GE(names.size(), 14u);
}

bool names(const part::CheckDimension& d, Mistake m) {
  return std::ranges::find(d.changes_with, m) != d.changes_with.end();
}

/// How the part measures after a mistake, by name; a place on the girth counts modulo the girth.
struct Seen {
  double most = 0.0;     // largest change of a dimension that names the mistake
  double unnamed = 0.0;  // largest change of one that does not
  std::string which = {};
};
Seen change(const Made& made, const GivenPart& bad, Mistake mistake) {
  const MeasuredSolid solid(bad);
  Seen out;
  for (const auto& d : made.part.check_dimensions) {
    double by = off(solid, d);
    if (d.name.ends_with("_girth")) by = std::min(by, kTwoPi * made.spec.target.outer_radius - by);
    if (!names(d, mistake)) {
      out.unnamed = std::max(out.unnamed, by);
    } else if (by > out.most) {
      out.most = by;
      out.which = d.name;
    }
  }
  return out;
}

/// The part made from a changed request, one mistake made in the program.
std::optional<GivenPart> remade(const PartSpec& spec) {
  const auto p = part::part(spec);
  if (!p) return std::nullopt;
  return given(spec, *p);
}

PartSpec clocked(PartSpec spec, bool finish) {
  for (auto& partner : (finish ? spec.finish : spec.start).cut.partners)
    if (auto* tube = std::get_if<joint::TubeCutter>(&partner))
      tube->clocking = tube->clocking + Angle::deg(finish ? -5 : 5);
  return spec;
}

/// The end cut the wrong way round: its table read from the other side.
GivenPart mirrored(GivenPart p, bool finish) {
  for (auto* e :
       {finish ? &p.finish_outer : &p.start_outer, finish ? &p.finish_inner : &p.start_inner}) {
    GivenEdge out;
    const auto n = e->phi.size();
    for (std::size_t k = 0; k < n; ++k) {
      const auto i = n - 1 - k;
      const double phi = e->phi[i] == 0 ? 0 : kTwoPi - e->phi[i];
      if (phi == 0) {
        out.phi.insert(out.phi.begin(), 0.0);
        out.z.insert(out.z.begin(), e->z[i]);
      } else {
        out.phi.push_back(phi);
        out.z.push_back(e->z[i]);
      }
    }
    *e = out;
  }
  return p;
}

/// The torch leans the wrong way about the root on the bore.
GivenPart swung(GivenPart p) {
  for (std::size_t i = 0; i < p.start_outer.z.size(); ++i)
    p.start_outer.z[i] -= 2 * (p.start_outer.z[i] - p.start_inner.z[i]);
  for (std::size_t i = 0; i < p.finish_outer.z.size(); ++i)
    p.finish_outer.z[i] -= 2 * (p.finish_outer.z[i] - p.finish_inner.z[i]);
  return p;
}

/// The same torch lines through a wall 2 mm thicker.
GivenPart thicker(GivenPart p) {
  const double wall = p.outer - p.inner;
  const auto run = [&](GivenEdge& o, GivenEdge& i) {
    for (std::size_t k = 0; k < o.z.size(); ++k)
      i.z[k] = o.z[k] + (i.z[k] - o.z[k]) / wall * (wall + 2);
  };
  run(p.start_outer, p.start_inner);
  run(p.finish_outer, p.finish_inner);
  p.inner -= 2;
  return p;
}

/// How much the surfaces differ at all: a mirrored end that is its own mirror is no mistake.
double differs(const GivenPart& a, const GivenPart& b) {
  double most = 0;
  const auto see = [&](const GivenEdge& x, const GivenEdge& y) {
    for (int k = 0; k < 360; ++k) {
      const auto at = [k](const GivenEdge& e) {
        const double phi = kTwoPi * k / 360;
        const auto n = e.phi.size();
        const auto j =
            static_cast<std::size_t>(std::ranges::upper_bound(e.phi, phi) - e.phi.begin());
        const auto i = (j + n - 1) % n;
        double from = e.phi[i], to = e.phi[j % n];
        if (from > phi) from -= kTwoPi;
        if (to <= phi) to += kTwoPi;
        return e.z[i] + (e.z[j % n] - e.z[i]) * (phi - from) / (to - from);
      };
      most = std::max(most, std::abs(at(x) - at(y)));
    }
  };
  see(a.start_outer, b.start_outer);
  see(a.finish_outer, b.finish_outer);
  return most;
}

struct Tally {
  int made = 0, seen = 0, no_mistake = 0;
  double least = 1e300, unnamed = 0;
};

TEST(CheckDimensions, EachPlantedMistakeIsSeenAndNamed) {
  std::map<std::string, Tally> tally;
  bool first = true;
  for (const auto& made : parts(60, 77)) {
    const auto good = given(made.spec, made.part);
    const auto see = [&](const std::string& name, Mistake mistake, const GivenPart& bad) {
      auto& t = tally[name];
      const auto change_seen = change(made, bad, mistake);
      ++t.made;
      t.least = std::min(t.least, change_seen.most);
      t.unnamed = std::max(t.unnamed, change_seen.unnamed);
      t.seen += change_seen.most > kSeen;
      EXPECT_GT(change_seen.most, kSeen) << name;
      if (first)
        std::printf("Table 1, %s: %s changes by %.2f mm\n", name.c_str(), change_seen.which.c_str(),
                    change_seen.most);
    };
    for (const bool finish : {false, true}) {
      if (finish && !made.spec.finish.welded) continue;
      if (const auto bad = remade(clocked(made.spec, finish)))
        see("clocking by 5 deg", Mistake::clocking, *bad);
      const auto bad = mirrored(good, finish);
      if (differs(good, bad) > 3.0)
        see("mirrored end", Mistake::mirror, bad);
      else
        ++tally["mirrored end"].no_mistake;
    }
    see("B of the wrong sign", Mistake::b_sign, swung(good));
    see("wall by 2 mm", Mistake::wall, thicker(good));
    auto fat = good;
    fat.outer += 1.5;
    fat.inner += 1.5;
    see("diameter by 3 mm", Mistake::diameter, fat);
    first = false;
  }
  for (const auto& [name, t] : tally)
    std::printf("%s: %d of %d seen, least change %.2f mm; %d alike\n", name.c_str(), t.seen, t.made,
                t.least, t.no_mistake);
  EXPECT_EQ(tally.size(), 5u);
}

// Also when the whole program was made for a tube 3 mm thicker, or a wall 2 mm thicker.
TEST(CheckDimensions, AProgramForAnotherTubeIsSeen) {
  double diameter = 1e300, wall = 1e300;
  for (const auto& made : parts(30, 5)) {
    auto other = made.spec;
    for (auto* target : {&other.target, &other.start.cut.target, &other.finish.cut.target})
      target->outer_radius += 1.5;
    if (const auto bad = remade(other))
      diameter = std::min(diameter, change(made, *bad, Mistake::diameter).most);
    other = made.spec;
    for (auto* target : {&other.target, &other.start.cut.target, &other.finish.cut.target})
      target->wall += 2;
    if (const auto bad = remade(other))
      wall = std::min(wall, change(made, *bad, Mistake::wall).most);
  }
  std::printf("another diameter: least %.2f mm; another wall: least %.2f mm\n", diameter, wall);
  EXPECT_GT(diameter, kSeen);
  EXPECT_GT(wall, kSeen);
}

// A mistake changes only the dimensions that name it, so the table can be read backwards.
TEST(CheckDimensions, AMistakeChangesOnlyTheNamedDimensions) {
  double worst = 0;
  for (const auto& made : parts(40, 9)) {
    const auto good = given(made.spec, made.part);
    worst = std::max({worst, change(made, swung(good), Mistake::b_sign).unnamed,
                      change(made, thicker(good), Mistake::wall).unnamed});
  }
  std::printf("largest change that is not named: %.3f mm\n", worst);
  EXPECT_LE(worst, kSeen + 0.01);
}

/// Each mistake is made on copies of both ends; of 20 000 points that takes 20 ms.
TEST(CheckDimensions, MakeNoMistakeWhenStopped) {
  const part::Edge edge{.phi = {0.0, 1.0, 4.0}, .z = {0.0, 3.0, 1.0}};
  part::Edge far = edge;
  for (auto& z : far.z) z += 100.0;
  const part::Shape shape{.outer_radius = 50.0,
                          .wall = 5.0,
                          .start_outer = edge,
                          .start_inner = edge,
                          .finish_outer = far,
                          .finish_inner = far};
  const auto named = [&] {
    std::size_t out = 0;
    for (const auto& d : part::check_dimensions(shape)) out += d.changes_with.size();
    return out;
  };
  EXPECT_GT(named(), 5U);
  const CancelledScope cancelled;
  EXPECT_EQ(named(), 0U);
}

}  // namespace
}  // namespace tubecut::testing
