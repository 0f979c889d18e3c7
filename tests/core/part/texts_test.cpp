#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "core/part/section/section_part.hpp"
#include "core/part/text_clearance.hpp"
#include "core/torch/marks.hpp"

/// Texts on drawn parts with sloped ends and openings: their distance to every edge by points of
/// the shapes themselves, in place of the rows of the cuts.
namespace tubecut::testing::part_texts {
namespace {

using namespace cutout;
using part::Part;
using part::PartSpec;
using part::SectionPart;
using part::SectionPartSpec;
using Random = std::mt19937;
using Point = Eigen::Vector2d;  // s and z

double between(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

constexpr double kLength = 400.0;
constexpr int kPlaces = 2000;  // of each edge

/// An end that a plane cuts, sloped by up to 20 deg.
part::EndSpec sloped_end(const Eigen::Vector3d& normal) {
  part::EndSpec out;
  out.cut.partners = {joint::PlaneCutter{{0, 0, 0}, normal}};
  out.cut.groove = bevel::NoGroove{};  // both edges lie on the plane
  out.cut.root_surface = bevel::RootSurface::inner;
  out.cut.smoothing = bevel::NoSmoothing{};
  out.cut.sampling.uniform_points = 720;
  out.cut.kerf = 1.0;
  out.welded = false;
  return out;
}

Eigen::Vector3d drawn_normal(Random& random) {
  return {between(random, -0.3, 0.3), between(random, -0.3, 0.3), -1.0};
}

PartSpec round_spec(double radius, const Eigen::Vector3d& start, const Eigen::Vector3d& finish) {
  PartSpec out{.target = {.outer_radius = radius, .wall = 4.0, .length = kLength},
               .start = sloped_end(start),
               .finish = sloped_end(finish),
               .holes = {}};
  out.start.cut.target = out.finish.cut.target = out.target;
  out.cutouts.kerf = 1.0;
  return out;
}

std::string drawn_word(Random& random) {
  std::string out;
  for (std::size_t i = 0, n = 1 + random() % 6; i < n; ++i)
    out += static_cast<char>('!' + random() % ('~' - '!' + 1));
  return out;
}

TextSpec drawn_text(Random& random, bool section) {
  TextSpec out{.id = "t", .text = drawn_word(random), .height = between(random, 3.0, 15.0)};
  out.turn = between(random, -3.2, 3.2);
  out.mirrored = random() % 3 == 0;
  out.over_corner = section;
  out.at.z = between(random, -10.0, kLength - 20.0);
  if (random() % 2 == 0) {
    out.at.from = Anchor::From::finish;
    out.at.z = kLength - out.at.z;
  }
  if (random() % 2 == 0) out.at.zero = Anchor::Zero::long_point;
  out.at.phi = between(random, -4.0, 4.0);
  return out;
}

Spec drawn_circle(Random& random, int index, int face) {
  Spec out{.id = "c" + std::to_string(index), .shape = Circle{between(random, 8.0, 20.0)}};
  out.at = {.z = 80.0 + 80.0 * index, .phi = between(random, 0.0, 6.0), .face = face};
  out.wall = Wall::developed;
  return out;
}

/// The nearest of many points to the strokes, round the tube too.
double nearest(const std::vector<Point>& edge, const Lettering& text, double girth) {
  double out = 1e9;
  for (const auto& stroke : text.strokes)
    for (std::size_t i = 1; i < stroke.size(); ++i) {
      const Point a(stroke[i - 1].y(), stroke[i - 1].x()), b(stroke[i].y(), stroke[i].x());
      for (const auto& p : edge) {
        const double turn = girth * std::round((0.5 * (a + b) - p).x() / girth);
        for (const double more : {-girth, 0.0, girth}) {
          const Point q = p + Point(turn + more, 0.0);
          const double t = std::clamp((q - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
          out = std::min(out, (a + t * (b - a) - q).norm());
        }
      }
    }
  return out;
}

/// z of an end's plane where a generator of the outside meets it. The part's z = 0 is `low`.
template <class OutlinePoint>
std::vector<Point> end_points(const OutlinePoint& point_at, double girth,
                              const Eigen::Vector3d& normal, bool finish, double low) {
  std::vector<Point> out;
  for (int i = 0; i < kPlaces; ++i) {
    const double s = girth * i / kPlaces;
    const Eigen::Vector2d p = point_at(s);
    const double rise = -(normal.x() * p.x() + normal.y() * (finish ? -p.y() : p.y())) / normal.z();
    out.emplace_back(s, (finish ? kLength - rise : rise) + low);
  }
  return out;
}

struct Seen {
  int kept = 0, refused = 0, off = 0, crossed = 0;
};

/// Compares the issues of one part with the distances of points.
void compare(const std::vector<Issue>& issues, const std::vector<Lettering>& all,
             const std::vector<Point>& start, const std::vector<Point>& finish,
             const std::vector<Point>& openings, double girth, double clearance, Seen& seen) {
  constexpr double kPoints = 0.03;  // mm: chords of the ends' rows, and between the points here
  for (const auto& text : all) {
    const auto path = path_of_text(text.asked);
    const auto count = [&](ErrorCode code) {
      return std::ranges::count_if(issues, [&](const Issue& issue) {
        return issue.code == code && (issue.member == path || issue.member.starts_with(path + "/"));
      });
    };
    const auto end_of = [&](const std::vector<Point>& edge, bool upper) {
      const double distance = nearest(edge, text, girth);
      // Beyond the edge where a stroke's first point is.
      const auto& p = text.strokes.front().front();
      const auto i = static_cast<std::size_t>(
          std::floor((p.y() / girth - std::floor(p.y() / girth)) * kPlaces));
      const bool beyond = upper ? p.x() > edge[i % kPlaces].y() : p.x() < edge[i % kPlaces].y();
      return beyond ? -distance : distance;
    };
    const double to_end = std::min(end_of(start, false), end_of(finish, true));
    const double to_opening = nearest(openings, text, girth);
    if (std::abs(to_end - clearance) > kPoints) {
      EXPECT_EQ(count(ErrorCode::cutout_off_part) > 0, to_end < clearance)
          << text.spec.text << " " << to_end;
      seen.off += to_end < clearance;
    }
    if (std::abs(to_opening - clearance) > kPoints && count(ErrorCode::cutouts_cross) == 0) {
      EXPECT_GT(to_opening, clearance) << text.spec.text;
    }
    for (const auto& issue : issues)
      if (issue.code == ErrorCode::cutouts_cross && issue.member == path) {
        const double got = std::get<double>(issue.got);
        ++seen.crossed;
        if (got > 0.05) {
          EXPECT_NEAR(got, to_opening, kPoints) << text.spec.text;
        }
      }
    ++(count(ErrorCode::cutout_off_part) + count(ErrorCode::cutouts_cross) > 0 ? seen.refused
                                                                               : seen.kept);
  }
}

void expect_all_kinds(const Seen& seen) {
  std::cout << "texts kept " << seen.kept << ", refused " << seen.refused << ", off the part "
            << seen.off << ", at openings " << seen.crossed << "\n";
  EXPECT_GT(seen.kept, 10);
  EXPECT_GT(seen.off, 5);
  EXPECT_GT(seen.crossed, 5);
}

/// The same part without its texts, and these texts laid on it.
template <class Made, class Spec>
std::pair<Made, LaidTexts> laid_on(Spec spec) {
  const auto texts = std::move(spec.cutouts.texts);
  spec.cutouts.texts.clear();
  Made made = [&] {
    if constexpr (std::is_same_v<Made, Part>)
      return part::part(spec).value();
    else
      return part::section_part(spec).value();
  }();
  auto laid = lay_texts(texts, cutout_ground(spec, made));
  return {std::move(made), std::move(laid)};
}

TEST(PartTexts, OfRoundPartsKeepOffEveryEdge) {
  Random random(20);
  Seen seen;
  for (int round = 0; round < 12; ++round) {
    const double radius = between(random, 25.0, 60.0), girth = kTwoPi * radius;
    const auto start = drawn_normal(random), finish = drawn_normal(random);
    auto spec = round_spec(radius, start, finish);
    spec.cutouts.kerf = round % 2 == 0 ? 1.0 : 3.0;
    for (int i = 0; i < 3; ++i) spec.cutouts.all.push_back(drawn_circle(random, i, 0));
    for (int i = 0; i < 12; ++i) spec.cutouts.texts.push_back(drawn_text(random, false));
    const auto [made, laid] = laid_on<Part>(spec);
    ASSERT_EQ(laid.all.size(), 12u);
    std::vector<Point> openings;
    for (const auto& one : spec.cutouts.all)
      for (int i = 0; i < kPlaces; ++i) {
        const double w = kTwoPi * i / kPlaces, r = 0.5 * std::get<Circle>(one.shape).diameter;
        openings.emplace_back(radius * one.at.phi + r * std::sin(w),
                              cutout_ground(spec, made).start_work + one.at.z + r * std::cos(w));
      }
    const auto place = [&](double s) {
      return Eigen::Vector2d(radius * std::cos(s / radius), radius * std::sin(s / radius));
    };
    const double low = cutout_ground(spec, made).start_work;
    compare(check_texts(spec, made, laid.all), laid.all,
            end_points(place, girth, start, false, low),
            end_points(place, girth, finish, true, low), openings, girth,
            std::max(2.0, spec.cutouts.kerf), seen);
  }
  expect_all_kinds(seen);
}

TEST(PartTexts, OfSquareAndFlatOvalPartsKeepOffEveryEdge) {
  Random random(21);
  Seen seen;
  for (int round = 0; round < 12; ++round) {
    const double height = between(random, 60.0, 110.0);
    const auto section = round % 2 == 0 ? section::Section{height, height, 4.0, 8.0, 4.0}
                                        : section::Section{50.0, height, 4.0, 25.0, 21.0};
    const auto outer = section.outer();
    const double girth = outer.girth();
    const auto start = drawn_normal(random), finish = drawn_normal(random);
    SectionPartSpec spec{.section = section,
                         .length = kLength,
                         .start = sloped_end(start),
                         .finish = sloped_end(finish)};
    spec.cutouts.kerf = 1.0;
    for (int i = 0; i < 3; ++i)
      spec.cutouts.all.push_back(drawn_circle(random, i, 1 + 2 * (i % 2)));
    for (auto& one : spec.cutouts.all) one.shape = Circle{8.0};
    for (int i = 0; i < 12; ++i) spec.cutouts.texts.push_back(drawn_text(random, true));
    for (std::size_t i = 0; i < 3; ++i) {  // some near the circles
      auto& at = spec.cutouts.texts[i].at;
      at = {.z = spec.cutouts.all[i].at.z + between(random, -15.0, 5.0),
            .face = spec.cutouts.all[i].at.face,
            .offset = between(random, -5.0, 5.0)};
    }
    const auto [made, laid] = laid_on<SectionPart>(spec);
    ASSERT_EQ(laid.all.size(), 12u);
    const double low = cutout_ground(spec, made).start_work;
    std::vector<Point> openings;
    for (const auto& one : spec.cutouts.all)
      for (int i = 0; i < kPlaces; ++i) {
        const double w = kTwoPi * i / kPlaces;
        openings.emplace_back(outer.on_face(one.at.face, 0.0) + 4.0 * std::sin(w),
                              low + one.at.z + 4.0 * std::cos(w));
      }
    const auto place = [&](double s) { return outer.at(s).point; };
    compare(check_texts(spec, made, laid.all), laid.all,
            end_points(place, girth, start, false, low),
            end_points(place, girth, finish, true, low), openings, girth, 2.0, seen);
  }
  expect_all_kinds(seen);
}

TEST(PartTexts, MovedToItsLimitATextIsAccepted) {
  Random random(22);
  int moved = 0;
  for (int round = 0; round < 20; ++round) {
    auto spec = round_spec(40.0, drawn_normal(random), drawn_normal(random));
    auto text = drawn_text(random, false);
    text.at.z = random() % 2 == 0 ? -30.0 : kLength + 30.0;
    spec.cutouts.texts = {text};
    const auto refused = part::part(spec);
    ASSERT_FALSE(refused);
    ASSERT_EQ(refused.error().issues.size(), 1u);
    const auto& issue = refused.error().issues.front();
    EXPECT_EQ(issue.code, ErrorCode::cutout_off_part);
    EXPECT_EQ(issue.member, "texts/0/at/z");
    const double limit = std::get<double>(issue.limit);
    spec.cutouts.texts[0].at.z = limit;
    EXPECT_TRUE(part::part(spec));
    spec.cutouts.texts[0].at.z = limit + (limit > text.at.z ? -1e-3 : 1e-3);
    EXPECT_FALSE(part::part(spec));
    ++moved;
  }
  EXPECT_EQ(moved, 20);
}

TEST(PartTexts, AreTheLastMarksAndStrokesOfTheTorchOnTheOutside) {
  auto spec = round_spec(40.0, {0, 0, -1}, {0, 0, -1});
  spec.name = "P1";
  spec.cutouts.texts = {{.id = "t", .at = {.z = 100.0, .phi = 1.0}, .text = "N1", .height = 14.0}};
  const auto made = part::part(spec).value();
  ASSERT_EQ(made.marks.size(), 3u);
  const auto& mark = made.marks.back();
  EXPECT_EQ(mark.kind, part::Mark::Kind::text);
  EXPECT_NEAR(mark.phi, 1.0, 1e-12);
  EXPECT_NEAR(mark.z_from, 100.0, 1e-9);
  EXPECT_NEAR(mark.z_to, 100.0 + 2.0 * (6.0 + 3.0), 1e-9);  // a 1 is three units wide
  const auto cuts = torch::with_marks(spec, made, {});
  ASSERT_EQ(cuts.size(), 1 + letter('N').size() + letter('1').size());
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const auto& stroke = mark.lettering->strokes[i - 1];
    EXPECT_TRUE(cuts[i].mark);
    EXPECT_EQ(cuts[i].path.phi.front() * 40.0, stroke.front().y());
    EXPECT_EQ(cuts[i].path.z.back(), stroke.back().x());
    EXPECT_EQ(cuts[i].name, "mark of text t, stroke " + std::to_string(i));
  }
}

}  // namespace
}  // namespace tubecut::testing::part_texts
