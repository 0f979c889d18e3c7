// A request that names the columns it wants of a table.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "api/wire/sha256.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

constexpr const char* kPath = "/v1/bevel-tables";

Json table_1() {
  return with(example("bevel-tables/source-000-table-1.json"), "sampling/uniform_points",
              Json{36.0});
}

Json naming(const Json& request, const std::vector<std::string>& names,
            std::string_view at = "columns") {
  Json::Array out;
  for (const auto& name : names) out.emplace_back(name);
  return with(request, at, Json{std::move(out)});
}

std::vector<std::string> names_of(const Json& object) {
  std::vector<std::string> out;
  for (const auto& [name, member] : *object.as<Json::Object>()) out.push_back(name);
  return out;
}

/// Omitting columns changes only the echoed request.
TEST(Columns, AreThoseNamedInTheOrderOfTheTable) {
  const auto whole = post(kPath, table_1());
  ASSERT_FALSE(whole.outcome.error) << whole.outcome.body.substr(0, 900);
  const auto all = names_of(at(whole.body, "result/points"));
  ASSERT_GT(all.size(), 10U);
  for (std::vector<std::string> names : {std::vector<std::string>{"b_deg", "phi_deg", "z_outer_mm"},
                                         {all.front()},
                                         {all.back()},
                                         all}) {
    const auto some = post(kPath, naming(table_1(), names));
    ASSERT_FALSE(some.outcome.error) << some.outcome.body.substr(0, 900);
    Json::Object kept;
    for (const auto& [name, column] : *at(whole.body, "result/points").as<Json::Object>())
      if (std::find(names.begin(), names.end(), name) != names.end())
        kept.emplace_back(name, column);
    EXPECT_EQ(api::dump(at(some.body, "result")),
              api::dump(with(at(whole.body, "result"), "points", Json{kept})));
    EXPECT_EQ(text(some.body, "job/result_sha256"), text(whole.body, "job/result_sha256"));
    EXPECT_EQ(text(some.body, "job/result_sha256"),
              api::sha256(api::dump(at(whole.body, "result"))));
    EXPECT_EQ(at(some.body, "verification"), at(whole.body, "verification"));
    EXPECT_EQ(at(some.body, "request/columns"), at(naming(table_1(), names), "columns"));
    EXPECT_EQ(post(kPath, at(some.body, "request")).outcome.body, some.outcome.body);
  }
}

TEST(Columns, AreThoseOfCborAndCsvToo) {
  const auto request = naming(table_1(), {"b_deg", "corner"});
  const auto json = post(kPath, request);
  const auto hash = [](const Posted& of) {
    for (const auto& [name, value] : of.outcome.headers)
      if (name == "Tubecut-Result-Sha256") return value;
    return std::string();
  };
  const auto cbor = post(kPath, api::dump(request), "format=cbor");
  ASSERT_FALSE(cbor.outcome.error);
  EXPECT_EQ(hash(cbor), text(json.body, "job/result_sha256"));
  api::Writer as_cbor(0, api::Encoding::cbor);
  as_cbor.json(json.body);
  EXPECT_EQ(cbor.outcome.body, as_cbor.take());

  const auto csv = post(kPath, api::dump(request), "format=csv");
  EXPECT_EQ(hash(csv), text(json.body, "job/result_sha256"));
  EXPECT_NE(csv.outcome.body.find("\nb_deg,corner\r\n"), std::string::npos);
  const auto whole = post(kPath, api::dump(table_1()), "format=csv");
  EXPECT_NE(whole.outcome.body.find("\nphi_deg,developed_mm,length_mm,"), std::string::npos);
}

TEST(Columns, ThatAreNotThereAreRefusedByTheirPlace) {
  struct Case {
    std::vector<std::string> names;
    const char* pointer;
    const char* hint;
  };
  for (const auto& [names, pointer, hint] :
       {Case{{"b_deg", "b"}, "/columns/1", ""},
        Case{{"b_deg", "phi_deg", "b_deg"}, "/columns/2", "named twice"},
        Case{{"z_face_mm"}, "/columns/0", "not of this table"}}) {
    const auto answer = post(kPath, naming(table_1(), names));
    ASSERT_TRUE(answer.outcome.error);
    EXPECT_EQ(at(answer.body, "errors").as<Json::Array>()->size(), 1U);
    EXPECT_EQ(text(answer.body, "errors/0/code"), "bad_choice");
    EXPECT_EQ(text(answer.body, "errors/0/pointer"), pointer);
    EXPECT_EQ(text(answer.body, "errors/0/got"), names.back());
    EXPECT_NE(text(answer.body, "errors/0/limit").find("phi_deg|developed_mm|"), std::string::npos);
    EXPECT_EQ(text(answer.body, "errors/0/limit").find("z_face_mm"), std::string::npos);
    if (*hint != '\0') {
      EXPECT_EQ(text(answer.body, "errors/0/hint"), hint);
    }
  }
  const auto with_land = with(table_1(), "root_face_mm", Json{1.0});
  EXPECT_FALSE(post(kPath, naming(with_land, {"z_face_mm"})).outcome.error);
  EXPECT_EQ(text(post(kPath, naming(table_1(), {})).body, "errors/0/pointer"), "/columns");
  EXPECT_EQ(text(post(kPath, with(table_1(), "columns", Json{"b_deg"})).body, "errors/0/code"),
            "wrong_type");
}

/// Of a cut within a schedule no points are printed: the same pulses.
TEST(Columns, OfACutWithinAnotherRequestChangeNothing) {
  const auto request = example("pulse-schedules/table-1-on-the-five-axis-cutter.json");
  ASSERT_NE(request.find("cut"), nullptr);
  const auto whole = post("/v1/pulse-schedules", request);
  const auto named = post("/v1/pulse-schedules", naming(request, {"b_deg"}, "cut/columns"));
  ASSERT_FALSE(named.outcome.error) << named.outcome.body.substr(0, 900);
  EXPECT_EQ(text(named.body, "job/result_sha256"), text(whole.body, "job/result_sha256"));
}

TEST(Columns, OfTheTablesOfANode) {
  const auto request = example("nodes/k-joint-with-tables.json");
  const auto whole = post("/v1/nodes", request);
  const auto some = post("/v1/nodes", naming(request, {"phi_deg", "b_deg"}, "tables/columns"));
  ASSERT_FALSE(some.outcome.error) << some.outcome.body.substr(0, 900);
  EXPECT_EQ(text(some.body, "job/result_sha256"), text(whole.body, "job/result_sha256"));
  std::size_t tables = 0;
  for (const auto& end : *at(some.body, "result/ends").as<Json::Array>()) {
    if (end.find("table") == nullptr) continue;
    ++tables;
    EXPECT_EQ(names_of(at(end, "table/points")), (std::vector<std::string>{"phi_deg", "b_deg"}));
  }
  EXPECT_GT(tables, 1U);
  const auto wrong = post("/v1/nodes", naming(request, {"b"}, "tables/columns"));
  EXPECT_EQ(text(wrong.body, "errors/0/pointer"), "/tables/columns/0");
}

}  // namespace
}  // namespace tubecut::testing
