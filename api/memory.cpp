// What jobs take of memory, by endpoint and format: measured on the most expensive valid requests,
// which server_job_memory_test runs, and rounded up.

#include "api/memory.hpp"

#include <algorithm>

namespace tubecut::api {
namespace {

/// Of a small job; the mesh of a mill is the most.
constexpr std::size_t kFixed = 4u << 20;

/// By the body: its tree of values, its echo and what an endpoint makes of it.
struct PerByte {
  std::string_view endpoint;
  std::size_t bytes;
};
constexpr std::size_t kPerByte = 48;
constexpr PerByte kPerBytes[] = {
    {"nodes", 96}, {"parts", 96}, {"frames", 160}, {"pulse-schedules", 96}, {"replays", 144}};

/// By what makes an answer long: points of a sampled curve (of a part: of each end and hole, of
/// a frame: of each part; of nodes: of each table), sections, positions, samples or rows of a
/// table, periods. A replay's periods are in its body.
struct PerItem {
  std::string_view endpoint;
  std::string_view format;
  std::size_t bytes;
};
constexpr PerItem kPerItems[] = {
    {"intersections", "json", 300},   {"intersections", "cbor", 350},
    {"intersections", "csv", 600},    {"intersections", "svg", 600},
    {"intersections", "pdf", 600},    {"intersections", "dxf", 1'800},
    {"bevel-tables", "json", 1'700},  {"bevel-tables", "cbor", 1'700},
    {"bevel-tables", "csv", 2'200},   {"bevel-tables", "svg", 1'800},
    {"bevel-tables", "pdf", 1'800},   {"bevel-tables", "dxf", 2'400},
    {"bevel-tables", "glb", 5'500},   {"bevel-tables", "stl", 1'700},
    {"bevel-tables", "step", 6'000},  {"bevel-tables", "nc1", 1'600},
    {"bevel-tables", "gcode", 1'600}, {"holes", "json", 2'000},
    {"holes", "cbor", 3'000},         {"holes", "csv", 3'800},
    {"holes", "svg", 2'200},          {"holes", "pdf", 2'200},
    {"holes", "dxf", 4'600},          {"holes", "step", 8'000},
    {"nodes", "json", 1'800},         {"nodes", "cbor", 1'800},
    {"parts", "json", 2'500},         {"parts", "cbor", 2'800},
    {"parts", "csv", 4'200},          {"parts", "svg", 2'800},
    {"parts", "pdf", 2'800},          {"parts", "dxf", 5'000},
    {"parts", "step", 8'000},         {"parts", "nc1", 3'000},
    {"parts", "gcode", 2'800},        {"frames", "json", 4'000},
    {"frames", "cbor", 4'000},        {"frames", "csv", 4'000},
    {"frames", "zip", 9'000},         {"frames", "step", 12'000},
    {"grooves", "json", 1'800},       {"grooves", "cbor", 2'500},
    {"grooves", "csv", 3'400},        {"grooves", "svg", 1'800},
    {"grooves", "glb", 3'100},        {"mill-paths", "json", 3'000},
    {"mill-paths", "cbor", 3'000},    {"mill-paths", "csv", 4'200},
    {"mill-paths", "svg", 3'600},     {"mill-paths", "glb", 10'500},
    {"feed-curves", "json", 600},     {"feed-curves", "cbor", 600},
    {"feed-curves", "csv", 1'000},    {"feed-curves", "svg", 700},
    {"feed-curves", "st", 600},       {"pulse-schedules", "json", 70},
    {"pulse-schedules", "cbor", 100}, {"pulse-schedules", "csv", 200},
    {"pulse-schedules", "svg", 200},  {"pulse-schedules", "gcode", 70},
};

}  // namespace

std::size_t most_per_byte() {
  std::size_t most = kPerByte;
  for (const auto& row : kPerBytes) most = std::max(most, row.bytes);
  return most;
}

JobBytes job_bytes(std::string_view endpoint, std::string_view format) {
  JobBytes out{.fixed = kFixed, .per_byte = kPerByte};
  for (const auto& row : kPerBytes)
    if (row.endpoint == endpoint) out.per_byte = row.bytes;
  for (const auto& row : kPerItems)
    if (row.endpoint == endpoint && row.format == format) out.per_item = row.bytes;
  return out;
}

}  // namespace tubecut::api
