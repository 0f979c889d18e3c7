#include "core/bevel/table/end_tables.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tubecut::bevel {
namespace {

/// A chord with braces of several sizes along it.
joint::NodeSpec ladder() {
  joint::NodeSpec out;
  out.members.push_back({.outer_radius = 100.0, .wall = 10.0, .name = "C"});
  out.members.back().start = {-1'000.0, 0.0, 0.0};
  out.members.back().finish = {3'000.0, 0.0, 0.0};
  for (int i = 0; i < 5; ++i) {
    joint::Member brace{
        .outer_radius = 30.0 + 10.0 * i, .wall = 5.0, .name = "B" + std::to_string(i)};
    brace.start = {500.0 * i, 0.0, 0.0};
    brace.finish = {500.0 * i + 200.0, 0.0, 900.0};
    brace.priority = 1;
    out.members.push_back(std::move(brace));
  }
  out.connect = joint::Within{20.0};
  return out;
}

TableSpec asked(std::size_t most) {
  TableSpec out;
  out.groove = FixedGroove{Angle::deg(30.0)};
  out.smoothing = NoSmoothing{};
  out.sampling.tolerance = joint::Tolerance{0.5};
  out.sampling.uniform_points = 0;
  out.sampling.max_nodes = most;
  return out;
}

void backwards(std::size_t count, const ParallelTask& task) {
  while (count-- > 0) task(count);
}

std::string shown(const Shown& value) {
  const auto* const number = std::get_if<double>(&value);
  return number != nullptr ? std::to_string(*number) : "-";
}

/// The tables in an answer, or the reason for their absence.
std::string told(const Result<std::vector<std::optional<EndTable>>>& tables) {
  std::string out;
  if (!tables) {
    for (const auto& issue : tables.error().issues)
      out += issue.member + " " + shown(issue.got) + " of " + shown(issue.limit);
    return out;
  }
  for (const auto& end : *tables) {
    out += end ? "table" : "none";
    if (end && end->refused) out += " refused";
    if (end && end->table)
      for (const double b : end->table->b) out += " " + std::to_string(b);
  }
  return out;
}

/// The tables of a node share its nodes, in the order of the ends: in any order of computation, the
/// same end finds too few left and reports it in the same way.
TEST(EndTables, AreTheSameInAnyOrder) {
  const auto node = ladder();
  const auto solved = joint::solve(node);
  ASSERT_TRUE(solved);
  const auto whole = end_tables(node, *solved, asked(100'000));
  ASSERT_TRUE(whole);
  std::size_t tables = 0, nodes = 0;
  for (const auto& end : *whole)
    if (end && end->table) ++tables, nodes += end->table->phi.size();
  ASSERT_EQ(tables, 5U);
  std::size_t refused = 0;
  for (std::size_t most = 0; most <= nodes + 5; most += 1 + nodes / 40) {
    const auto one_by_one = end_tables(node, *solved, asked(most));
    EXPECT_EQ(told(one_by_one), told(end_tables(node, *solved, asked(most), backwards))) << most;
    refused += one_by_one ? 0 : 1;
  }
  EXPECT_GT(refused, 20U);
  EXPECT_EQ(told(whole), told(end_tables(node, *solved, asked(100'000), backwards)));
  EXPECT_EQ(told(whole), told(end_tables(node, *solved, asked(nodes), backwards)));
}

}  // namespace
}  // namespace tubecut::bevel
