#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/base/error.hpp"
#include "core/joint/intersection.hpp"
#include "tests/support/call.hpp"
#include "tests/support/cancelled.hpp"

namespace tubecut::testing {
namespace {

using api::Json;
using Object = Json::Object;
using Array = Json::Array;

constexpr const char* kBevel = "/v1/bevel-tables";
constexpr const char* kCut = "/v1/intersections";

Json table_1() { return example("bevel-tables/source-000-table-1.json"); }
Json cut() { return example("intersections/source-000-table-1.json"); }

Json object(Object members) { return Json{std::move(members)}; }
Json list(Array items) { return Json{std::move(items)}; }
Json tube(double inclination, double offset = 0.0, double diameter = 110.0) {
  return object({{"kind", "tube"},
                 {"outer_diameter_mm", diameter},
                 {"inclination_deg", inclination},
                 {"offset_mm", offset}});
}
Json axis_tube(double x, double y, double z) {
  return object(
      {{"kind", "tube"},
       {"outer_diameter_mm", 110.0},
       {"axis", object({{"point_mm", list({0.0, 0.0, 0.0})}, {"direction", list({x, y, z})}})}});
}
Json plane(double x, double y, double z) {
  return object(
      {{"kind", "plane"}, {"point_mm", list({0.0, 0.0, -200.0})}, {"normal", list({x, y, z})}});
}
/// The request with one more cutter behind those it has.
Json plus(const Json& request, Json cutter) {
  auto cutters = *at(request, "cutters").as<Array>();
  cutters.push_back(std::move(cutter));
  return with(request, "cutters", Json{std::move(cutters)});
}
Json hermite(Json points, double limit = 10.0) {
  return object({{"method", "hermite"},
                 {"mutation_limit_deg", limit},
                 {"transition_points", std::move(points)}});
}

/// Expected first field of a problem.
struct Expected {
  std::string code;
  std::string pointer;
  bool got = true;    // a value is shown
  bool limit = true;  // and its limit
};

void expect_envelope(const Posted& answer, const std::string& code) {
  ASSERT_TRUE(answer.outcome.error) << answer.outcome.body.substr(0, 500);
  EXPECT_EQ(answer.outcome.content_type, "application/problem+json");
  EXPECT_EQ(text(answer.body, "code"), code) << answer.outcome.body;
  EXPECT_EQ(text(answer.body, "type"), "/v1/errors#" + code);
  EXPECT_EQ(text(answer.body, "request_id"), "test");
  EXPECT_EQ(at(answer.body, "retryable"), Json{false});
  for (const auto* field : {"title", "detail", "action"}) EXPECT_NE(text(answer.body, field), "");
}

void expect_problem(const Posted& answer, const Expected& expected) {
  expect_envelope(answer, expected.code);
  const auto& first = at(answer.body, "errors/0");
  EXPECT_EQ(text(first, "pointer"), expected.pointer) << answer.outcome.body;
  EXPECT_EQ(at(first, "got") != Json{}, expected.got) << answer.outcome.body;
  EXPECT_EQ(at(first, "limit") != Json{}, expected.limit) << answer.outcome.body;
  EXPECT_NE(text(answer.body, "detail").find(expected.pointer), std::string::npos);
}

std::set<std::string> warnings(const Posted& answer) {
  std::set<std::string> out;
  EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1000);
  for (const auto& warning : *at(answer.body, "warnings").as<Array>())
    out.insert(text(warning, "code"));
  return out;
}

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, 32> digest{};
  EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
  std::string out;
  for (const auto byte : digest) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 15];
  }
  return out;
}

// ---- impossible cuts

TEST(Problems, OpenProfileNamesItsIntervals) {
  for (const auto* path : {kBevel, kCut}) {
    const auto request = path == kBevel ? table_1() : cut();
    const auto answer = post(path, with(request, "cutters", list({tube(60.0, 0.0, 40.0)})));
    expect_problem(answer, {"open_profile", "/cutters"});
    // |30 cos phi| beyond the partner's radius of 20: around phi = 0 and 180 deg.
    const double border = 48.18968510422141;  // acos(20 / 30): the inner surface is computed first
    const auto& intervals = *at(answer.body, "errors/0/got").as<Array>();
    ASSERT_EQ(intervals.size(), 2u);
    EXPECT_NEAR(number(intervals[0], "0"), 180.0 - border, 1e-9);
    EXPECT_NEAR(number(intervals[0], "1"), 180.0 + border, 1e-9);
    EXPECT_NEAR(number(intervals[1], "0"), 360.0 - border, 1e-9);
    EXPECT_NEAR(number(intervals[1], "1"), 360.0 + border, 1e-9);
    EXPECT_EQ(text(answer.body, "errors/0/unit"), "deg");
  }
}

TEST(Problems, AllMissedIsAnErrorOneMissedAWarning) {
  const auto none = with(table_1(), "cutters", list({tube(60.0, 500.0), tube(60.0, -500.0)}));
  expect_problem(post(kBevel, none), {"no_contact", "/cutters"});
  const auto one = post(kBevel, plus(table_1(), tube(60.0, 500.0)));
  EXPECT_EQ(warnings(one).count("cutter_missed"), 1u);
  EXPECT_EQ(text(one.body, "warnings/0/pointer"), "/cutters/4");
  EXPECT_EQ(text(one.body, "verdict/status"), "ok");
}

TEST(Problems, ParallelAxesHoweverTheyAreGiven) {
  expect_problem(post(kBevel, plus(table_1(), tube(5e-5))),
                 {"parallel_axes", "/cutters/4/inclination_deg"});
  expect_problem(post(kCut, plus(cut(), tube(179.99995))),
                 {"parallel_axes", "/cutters/4/inclination_deg"});
  expect_problem(post(kBevel, plus(table_1(), axis_tube(0.0, 0.0, -3.0))),
                 {"parallel_axes", "/cutters/4/axis/direction"});
  expect_problem(post(kCut, plus(cut(), plane(1.0, 0.0, 0.0))),
                 {"parallel_axes", "/cutters/4/normal"});
  const auto answer = post(kCut, plus(cut(), tube(5e-5)));
  EXPECT_NEAR(number(answer.body, "errors/0/limit"), 5.73e-5, 1e-7);
  EXPECT_NEAR(number(answer.body, "errors/0/got"), 5e-5, 1e-12);
}

TEST(Problems, NoLength) {
  expect_problem(post(kCut, plus(cut(), axis_tube(0.0, 0.0, 0.0))),
                 {"zero_length", "/cutters/4/axis/direction"});
  expect_problem(post(kCut, plus(cut(), plane(0.0, 0.0, 0.0))),
                 {"zero_length", "/cutters/4/normal"});
}

TEST(Problems, TorchRangeReportsPositionAndGap) {
  const auto answer = post(kBevel, with(table_1(), "torch/max_deg", 20.0));
  expect_problem(answer, {"torch_range", "/torch/max_deg"});
  EXPECT_EQ(number(answer.body, "errors/0/limit"), 20.0);
  EXPECT_FALSE(at(answer.body, "errors/0/got").as<Array>()->empty());
  EXPECT_NE(text(answer.body, "errors/0/hint").find("mm"), std::string::npos);
}

TEST(Problems, MemberConsumed) {
  const auto highest = [](const std::vector<double>& z) { return *std::ranges::max_element(z); };
  const auto whole = post(kCut, cut());
  const double top = std::max(highest(numbers(whole.body, "result/profiles/0/points/z_mm")),
                              highest(numbers(whole.body, "result/profiles/1/points/z_mm")));
  EXPECT_FALSE(post(kCut, with(cut(), "target/length_mm", top)).outcome.error);
  const auto answer = post(kCut, with(cut(), "target/length_mm", top - 1e-9));
  expect_problem(answer, {"member_consumed", "/target/length_mm"});
  EXPECT_EQ(number(answer.body, "errors/0/got"), top);
  expect_problem(post(kBevel, with(table_1(), "target/length_mm", 50.0)),
                 {"member_consumed", "/target/length_mm"});
}

// We found no request within the limits that needs 100 000 nodes (37 052 at most), so this calls
// core with a lower limit.
TEST(Problems, TooManyNodes) {
  const joint::IntersectionSpec spec{
      .target = {.outer_radius = 35.0, .wall = 5.0},
      .partners = {joint::TubeCutter{.radius = 55.0, .inclination = Angle::deg(60)}},
      .sampling = {.tolerance = joint::Tolerance{.value = 1e-4}, .max_nodes = 50}};
  const auto answer = joint::intersect(spec);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code(), ErrorCode::too_many_nodes);
  EXPECT_EQ(answer.error().issues.front().member, "sampling");
  EXPECT_EQ(answer.error().issues.front().limit, Shown{50.0});
}

/// A wide kerf allows fewer points; a request with the number in the refusal is answered.
TEST(Problems, TooManyNodesForTheKerfNamesHowMany) {
  const auto points = [](double count) {
    return with(with(table_1(), "kerf_mm", 20.0), "sampling", object({{"uniform_points", count}}));
  };
  const auto refused = post(kBevel, points(20'000.0));
  expect_problem(refused, {"too_many_nodes", "/sampling"});
  const auto most = number(refused.body, "errors/0/limit");
  EXPECT_LT(most, 20'000.0);
  EXPECT_FALSE(post(kBevel, points(most)).outcome.error);
  expect_problem(post(kBevel, points(most + 1.0)), {"too_many_nodes", "/sampling"});
}

// ---- smoothing as published

TEST(Problems, PublishedSmoothing) {
  const auto free = with(table_1(), "contact", "none");
  const auto uneven = with(free, "sampling", object({{"tolerance_mm", 0.1}}));
  expect_problem(post(kBevel, with(uneven, "smoothing", hermite(15.0))),
                 {"sampling_not_uniform", "/sampling/tolerance_mm"});
  expect_problem(post(kBevel, with(free, "smoothing", hermite(2.0, 0.01))),
                 {"smoothing_not_converged", "/smoothing/transition_points"});
  expect_problem(post(kBevel, with(free, "smoothing", hermite("auto", 2.0))),
                 {"transition_too_long", "/smoothing/transition_points"});
  const auto long_window = post(kBevel, with(free, "smoothing", hermite(91.0)));
  expect_problem(long_window, {"out_of_range", "/smoothing/transition_points"});
  EXPECT_EQ(number(long_window.body, "errors/0/limit"), 90.0);
}

TEST(Problems, PublishedSmoothingMayEnterAPartner) {
  // A thin wall and a flush groove: only the clearance of partners remains, and a long window falls
  // below it.
  auto request = with(table_1(), "groove", object({{"rule", "none"}}));
  request = with(with(request, "target/wall_mm", 3.0), "smoothing", hermite(30.0, 5.0));
  const auto answer = post(kBevel, request);
  expect_problem(answer, {"smoothing_enters", "/smoothing/method"});
  EXPECT_FALSE(at(answer.body, "errors/0/got").as<Array>()->empty());
  EXPECT_EQ(warnings(post(kBevel, with(request, "contact", "none"))).count("smoothed_below_raw"),
            1u);
}

// ---- fields

TEST(Problems, FieldsNameThemselves) {
  const struct {
    const char* path;
    Json value;
    Expected expected;
  } kCases[] = {
      {"target/wall_mm", 0.0, {"out_of_range", "/target/wall_mm"}},
      {"target/wall_mm", 35.0, {"out_of_range", "/target/wall_mm"}},
      {"target/wall_mm", 40.0, {"out_of_range", "/target/wall_mm"}},
      {"target/kind", "square", {"unsupported_target", "/target/kind"}},
      {"target/outer_diameter_mm",
       true,
       {"not_a_number", "/target/outer_diameter_mm", true, false}},
      {"target/outer_diameter_mm", 2.75, {"out_of_range", "/target/outer_diameter_mm"}},
      {"sampling/uniform_points", 1e6, {"out_of_range", "/sampling/uniform_points"}},
      {"sampling/uniform_points",
       36.5,
       {"not_an_integer", "/sampling/uniform_points", true, false}},
      {"cutters/1/hieght_mm", 15.0, {"unknown_field", "/cutters/1/hieght_mm", true, false}},
      {"cutters/2/axis",
       object({}),
       {"exclusive_fields", "/cutters/2/inclination_deg", true, false}},
      {"cutters/0/kind", "pyramid", {"bad_choice", "/cutters/0/kind"}},
      {"cutters/0", 5.0, {"wrong_type", "/cutters/0", true, false}},
      {"cutters", list({}), {"wrong_count", "/cutters"}},
      {"cutters", Json{Array(65, tube(80.0))}, {"wrong_count", "/cutters"}},
      {"groove/rule", "narrow", {"bad_choice", "/groove/rule"}},
      {"contact", "outer", {"unsupported_combination", "/contact"}},
      {"root_surface", "outer", {"unsupported_combination", "/contact"}},
      {"dihedral", "inside", {"unsupported_combination", "/dihedral"}},
      {"dihedral", "as_published", {"unsupported_combination", "/dihedral"}},
      {"torch", object({{"min_deg", 10.0}, {"max_deg", 10.0}}), {"out_of_range", "/torch/max_deg"}},
      {"root_face_mm", 500.0, {"out_of_range", "/root_face_mm"}},
      {"numerics", 999.0, {"numerics_mismatch", "/numerics"}},
      {"reference", object({{"part", "\n"}}), {"bad_text", "/reference/part"}},
  };
  for (const auto& c : kCases) {
    SCOPED_TRACE(c.path);
    expect_problem(post(kBevel, with(table_1(), c.path, c.value)), c.expected);
  }
  const auto typo = post(kBevel, with(table_1(), "cutters/1/hieght_mm", 15.0));
  EXPECT_EQ(text(typo.body, "errors/0/hint"), "did you mean height_mm?");
  EXPECT_EQ(at(typo.body, "errors").as<Array>()->size(), 1u);
  const auto twice = post(kBevel, with(table_1(), "kerfmm", 1.5));
  EXPECT_EQ(text(twice.body, "errors/0/hint"), "kerf_mm is given already; remove one of the two");
}

TEST(Problems, MissingFieldsPointToThemselves) {
  for (const auto* path : {"cutters", "root_surface", "groove", "kerf_mm", "smoothing",
                           "target/wall_mm", "smoothing/limits", "cutters/0/kind"}) {
    SCOPED_TRACE(path);
    const auto answer = post(kBevel, without(table_1(), path));
    expect_problem(answer, {"missing_field", "/" + std::string(path), false, false});
    EXPECT_LE(at(answer.body, "errors").as<Array>()->size(),
              2u);  // the second names the alternative
  }
  // Of fields of which exactly one is needed, each is named.
  const std::pair<const char*, const char*> kEither[] = {
      {"target", "/node"},
      {"cutters/0/inclination_deg", "/cutters/0/axis"},
      {"cutters/0/outer_diameter_mm", "/cutters/0/size"}};
  for (const auto& [path, other] : kEither) {
    const auto answer = post(kBevel, without(table_1(), path));
    expect_problem(answer, {"missing_field", "/" + std::string(path), false, false});
    EXPECT_EQ(text(answer.body, "errors/1/pointer"), other);
  }
}

TEST(Problems, EveryIssueInOneReply) {
  auto request = with(table_1(), "target/wall_mm", true);
  request = with(with(request, "kerf_mm", -1.0), "root_surface", "middle");
  const auto answer = post(kBevel, with(request, "colour", "red"));
  expect_envelope(answer, "invalid_request");
  std::set<std::string> named;
  for (const auto& issue : *at(answer.body, "errors").as<Array>())
    named.insert(text(issue, "pointer"));
  EXPECT_TRUE(named.contains("/target/wall_mm") && named.contains("/kerf_mm") &&
              named.contains("/root_surface"))
      << answer.outcome.body;
}

TEST(Problems, NoMoreThan32AreNamed) {
  auto many = *table_1().as<Object>();
  for (int i = 0; i < 5000; ++i) many.emplace_back("x" + std::to_string(i), 1.0);
  EXPECT_EQ(at(post(kBevel, Json{std::move(many)}).body, "errors").as<Array>()->size(), 32u);
}

// ---- bytes and words

TEST(Problems, BytesThatAreNoJson) {
  const std::pair<std::string, int> kCases[] = {{std::string(200'000, '['), 32},
                                                {R"({"a":1,"a":2})", 10},
                                                {R"({"a":NaN})", 5},
                                                {"", 0},
                                                {R"({"a":1e})", 5},
                                                {R"({"a":1}x)", 7},
                                                {"\xef\xbb\xbf{}", 0}};
  for (const auto& [body, offset] : kCases) {
    SCOPED_TRACE(body.substr(0, 20));
    const auto answer = post(kBevel, std::string_view(body));
    expect_envelope(answer, "unreadable_json");
    const auto detail = text(answer.body, "detail");
    const auto place = detail.rfind(" at byte ");
    ASSERT_NE(place, std::string::npos) << detail;
    EXPECT_NEAR(std::stod(detail.substr(place + 9)), offset, 6) << detail;
  }
}

TEST(Problems, WrongRoot) {
  for (const auto* body : {"[]", "null", "3", "\"text\"", "true"})
    expect_problem(post(kBevel, std::string_view(body)), {"wrong_type", "", body[0] != 'n', false});
}

TEST(Problems, ABodyOfKeysInDescendingOrderIsReadInLittleTime) {
  auto body = api::dump(table_1());
  for (int i = 99'999; i >= 10'000; --i) {
    body.back() = ',';
    body += "\"" + std::to_string(i) + "\":1}";
  }
  expect_envelope(post(kBevel, std::string_view(body)), "unknown_field");
}

TEST(Problems, FormatsThatThereAreNot) {
  const auto body = api::dump(table_1());
  for (const auto& answer :
       {post(kBevel, body, "", "image/png"), post(kBevel, body, "format=xml")}) {
    expect_envelope(answer, "not_acceptable");
    const auto detail = text(answer.body, "detail");
    EXPECT_NE(detail.find("application/json"), std::string::npos) << detail;
    EXPECT_NE(detail.find("application/cbor"), std::string::npos) << detail;
  }
  expect_envelope(post(kBevel, body, "colour=red"), "bad_request");
  expect_envelope(post(kBevel, body, "validate_only=1"), "bad_request");
  expect_envelope(post("/v1/nothing", std::string_view(body)), "not_found");
}

// ---- the query

struct BadQuery {
  const char *query, *pointer, *code, *hint;
};

TEST(Query, ErrorsNameTheValidValues) {
  const auto body = api::dump(table_1());
  constexpr BadQuery kBad[] = {
      {"format=gcode&speed_mm_min=600&dialect=fanuc", "?dialect", "bad_choice", "qtplasmac"},
      {"format=gcode&speed_mm_min=600&torch=yes", "?torch", "bad_choice", "on|off"},
      {"format=gcode&speed_mm_min=600&lead_mm=-1", "?lead_mm", "out_of_range", "at least 0 mm"},
      {"format=gcode&speed_mm_min=0.5", "?speed_mm_min", "out_of_range", "at least 1 mm_min"},
      {"format=gcode&speed_mm_min=fast", "?speed_mm_min", "not_a_number", "number"},
      {"format=gcode", "?speed_mm_min", "missing_field", "speed"},
      {"validate_only=yes", "?validate_only", "wrong_type", "true or false"},
      {"validate_olny=true", "?validate_olny", "unknown_field", "validate_only"},
      {"format=csv&format=svg", "?format", "repeated_parameter", ""},
      {"format=csv&mirror=true", "?mirror", "unsupported_combination", "csv"},
      {"format=svg&view=t%65mplat", "?view", "bad_choice", "template"}};
  for (const auto& bad : kBad) {
    const auto answer = post(kBevel, body, bad.query);
    const auto* issues = answer.body.find("errors");
    ASSERT_TRUE(issues != nullptr && issues->as<Json::Array>()->size() == 1) << bad.query;
    const auto& issue = issues->as<Json::Array>()->front();
    EXPECT_EQ(text(issue, "pointer"), bad.pointer) << bad.query;
    EXPECT_EQ(text(issue, "code"), bad.code) << bad.query;
    EXPECT_NE(text(issue, "hint").find(bad.hint), std::string::npos) << text(issue, "hint");
  }
}

TEST(Query, AllErrorsAreReportedAtOnceWithoutEncoding) {
  const auto body = api::dump(table_1());
  const auto answer = post(kBevel, body, "torch=1&lead_mm=-1&colour=red");
  EXPECT_EQ(text(answer.body, "code"), "bad_request");
  EXPECT_EQ(answer.body.find("errors")->as<Json::Array>()->size(), 3u);
  EXPECT_NE(post(kBevel, body, "%66ormat=%63sv").outcome.content_type.find("csv"),
            std::string::npos);
}

// ---- warnings and verdicts

TEST(Warnings, NearParallel) {
  EXPECT_EQ(warnings(post(kCut, plus(cut(), tube(4.9)))).count("near_parallel"), 1u);
  EXPECT_EQ(warnings(post(kCut, plus(cut(), tube(5.1)))).count("near_parallel"), 0u);
}

TEST(Warnings, EventsBetweenNodesOnABareGridOnly) {
  EXPECT_EQ(warnings(post(kBevel, table_1())).count("events_between_nodes"), 1u);
  const auto exact = with(table_1(), "sampling/tolerance_mm", 0.5);
  EXPECT_EQ(warnings(post(kBevel, exact)).count("events_between_nodes"), 0u);
}

TEST(Warnings, ARuleBeyondTheTorchRequiresReview) {
  auto request = with(with(table_1(), "contact", "none"), "torch/max_deg", 30.0);
  const auto answer = post(kBevel, request);
  EXPECT_EQ(warnings(answer).count("torch_range_binds"), 1u);
  EXPECT_EQ(text(answer.body, "verdict/status"), "review");
  EXPECT_EQ(text(answer.body, "verdict/reasons/0"), "torch_range_binds");
  const auto& binds = *at(answer.body, "result/torch_binds").as<Array>();
  ASSERT_FALSE(binds.empty());
  for (const auto& bind : binds) EXPECT_GT(number(bind, "groove_lost_deg"), 0.0);
}

TEST(Warnings, BeyondAcceptIsRejected) {
  const auto b = numbers(post(kBevel, table_1()).body, "result/points/b_deg");
  const double most = *std::ranges::max_element(b);
  const auto accepting = with(table_1(), "accept", object({}));
  EXPECT_EQ(
      text(post(kBevel, with(accepting, "accept/max_b_deg", most + 1e-6)).body, "verdict/status"),
      "ok");
  const auto rejected = post(kBevel, with(accepting, "accept/max_b_deg", most - 1e-3));
  EXPECT_EQ(text(rejected.body, "verdict/status"), "reject");
  EXPECT_EQ(text(rejected.body, "verdict/reasons/0").substr(0, 9), "max_b_deg");
}

// ---- the envelope

TEST(Envelope, HashesAreOfThePrintedBytes) {
  for (const auto* path : {kBevel, kCut}) {
    const auto answer = post(path, path == kBevel ? table_1() : cut());
    const auto& body = answer.outcome.body;
    const auto part = [&](std::string_view from, std::string_view to) {
      const auto begin = body.find(from) + from.size();
      return std::string_view(body).substr(begin, body.find(to) - begin);
    };
    EXPECT_EQ(text(answer.body, "job/input_sha256"),
              sha256_hex(part("\"request\":", ",\"result\":")));
    EXPECT_EQ(text(answer.body, "job/result_sha256"),
              sha256_hex(part("\"result\":", ",\"verification\":")));
  }
}

TEST(Envelope, ReferenceAndLogAreOutsideTheHash) {
  const auto bare = post(kBevel, table_1());
  auto request = with(table_1(), "reference", object({{"part", "P-7"}, {"heat", "H 12"}}));
  const auto marked = post(kBevel, with(request, "log", "inline"));
  for (const auto* field : {"job/input_sha256", "job/result_sha256", "job/id"})
    EXPECT_EQ(text(bare.body, field), text(marked.body, field));
  EXPECT_EQ(text(marked.body, "request/reference/part"), "P-7");
  EXPECT_EQ(text(marked.body, "request/log"), "inline");
  EXPECT_EQ(bare.body.find("log"), nullptr);
  EXPECT_NE(marked.body.find("log"), nullptr);
  const std::pair<std::string, std::string> part{"part", "P-7"};
  EXPECT_EQ(marked.outcome.job.reference.front(), part);
}

TEST(Envelope, JobIdIsTheCallersOrOfTheInput) {
  const auto body = api::dump(cut());
  api::Call call{.method = "POST",
                 .path = kCut,
                 .query = {},
                 .accept = {},
                 .content_type = "application/json",
                 .body = body,
                 .job_id = "order 7",
                 .request_id = "test"};
  const api::Context context{.clock = {}, .status = [](ErrorKind) { return 400; }};
  const auto named = *api::parse(api::dispatch(call, context).body);
  EXPECT_EQ(text(named, "job/id"), "order 7");
  call.job_id.clear();
  const auto unnamed = *api::parse(api::dispatch(call, context).body);
  EXPECT_EQ(text(unnamed, "job/id"), text(unnamed, "job/input_sha256").substr(0, 16));
  EXPECT_EQ(text(named, "job/input_sha256"), text(unnamed, "job/input_sha256"));
}

TEST(Envelope, ValidateOnlyHasTheRealVerdictAndNoResult) {
  const auto request = api::dump(with(table_1(), "accept", object({{"max_b_deg", 10.0}})));
  const auto full = post(kBevel, std::string_view(request));
  const auto dry = post(kBevel, request, "validate_only=true");
  EXPECT_EQ(dry.body.find("result"), nullptr);
  for (const auto* field : {"job", "request", "verification", "verdict", "warnings"})
    EXPECT_EQ(at(full.body, field), at(dry.body, field));
}

TEST(Envelope, DefaultsAreEchoed) {
  auto request = without(without(table_1(), "sampling"), "contact");
  const auto answer = post(kBevel, without(request, "groove/cap_deg"));
  const auto& echo = at(answer.body, "request");
  EXPECT_EQ(number(echo, "sampling/tolerance_mm"), 0.05);
  EXPECT_EQ(text(echo, "sampling/metric"), "developed");
  EXPECT_EQ(text(echo, "target/kind"), "round");
  EXPECT_EQ(text(echo, "contact"), "inner");
  EXPECT_EQ(text(echo, "dihedral"), "weld_side");
  EXPECT_EQ(number(echo, "groove/cap_deg"), 45.0);
  EXPECT_EQ(number(echo, "torch/min_deg"), -80.0);
  EXPECT_EQ(number(echo, "torch/max_deg"), 80.0);
  EXPECT_EQ(text(echo, "smoothing/along"), "developed");
  EXPECT_EQ(at(echo, "smoothing/refine"), Json{true});
  EXPECT_EQ(number(echo, "smoothing/mutation_limit_deg"), 10.0);
  EXPECT_EQ(number(echo, "cutters/0/height_mm"), 0.0);
}

TEST(Problems, ALongUnknownNameIsCutAndNamedOnce) {
  const std::string name(100'000, 'k');
  const auto answer = post("/v1/bevel-tables", std::string_view("{\"" + name + "\":1}"));
  ASSERT_TRUE(answer.outcome.error);
  EXPECT_LT(answer.outcome.body.size(), 3000U);
  EXPECT_NE(answer.outcome.body.find("a field whose name has 100000 bytes"), std::string::npos);
  EXPECT_EQ(answer.outcome.body.find(name.substr(0, 201)), std::string::npos);
  const auto within = post("/v1/intersections", with(cut(), "cutters/0/" + name, Json{1.0}));
  EXPECT_EQ(text(within.body, "errors/0/pointer"), "/cutters/0");
  const auto query = post("/v1/bevel-tables", std::string_view("{}"), name);
  ASSERT_TRUE(query.outcome.error);
  EXPECT_EQ(text(*api::parse(query.outcome.body), "code"), "bad_request");
  EXPECT_LT(query.outcome.body.size(), 3000U);
}

/// Its refusal is written although the work of its thread is cancelled, at any size of the body.
TEST(Envelope, ACancelledJobIsRefusedByItsCode) {
  const api::Context context{.clock = {}, .status = [](ErrorKind) { return 504; }};
  for (const std::size_t size : {2U, 5'000'000U}) {
    const std::string body = "{" + std::string(size - 2, ' ') + "}";
    const api::Call call{.method = "POST",
                         .path = "/v1/bevel-tables",
                         .query = {},
                         .accept = {},
                         .content_type = "application/json",
                         .body = body,
                         .job_id = {},
                         .request_id = "r"};
    const CancelledScope cancelled;
    const auto outcome = api::dispatch(call, context);
    EXPECT_EQ(outcome.error, ErrorKind::timeout) << size;
    EXPECT_NE(outcome.body.find("over_budget"), std::string::npos) << size;
  }
}

TEST(Envelope, EveryCodeHasAnAction) {
  for (const auto& error : all_errors()) {
    EXPECT_FALSE(error.meaning.empty()) << error.code;
    EXPECT_TRUE(error.action.ends_with('.')) << error.code;
  }
  for (const auto& warning : all_warnings()) {
    EXPECT_FALSE(warning.meaning.empty()) << warning.code;
    EXPECT_TRUE(warning.action.ends_with('.')) << warning.code;
  }
  const api::Context context{.clock = {}, .status = [](ErrorKind) { return 503; }};
  const auto busy = *api::parse(api::problem(ErrorCode::overloaded, "", "r", context).body);
  EXPECT_EQ(at(busy, "retryable"), Json{true});
}

}  // namespace
}  // namespace tubecut::testing
