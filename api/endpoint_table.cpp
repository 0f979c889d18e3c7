#include "api/batch.hpp"
#include "api/endpoint.hpp"
#include "api/endpoints/all.hpp"
#include "api/limits.hpp"

namespace tubecut::api {

std::span<const Endpoint> endpoints() {
  static const std::vector<Endpoint> kTable{
      intersections(),   nodes(),   bevel_tables(), holes(),   parts(),      frames(),
      pulse_schedules(), replays(), feed_curves(),  grooves(), mill_paths(),
  };
  return kTable;
}

std::vector<std::string_view> endpoint_ids() {
  std::vector<std::string_view> out;
  for (const auto& endpoint : endpoints()) out.push_back(endpoint.id);
  return out;
}

std::size_t max_body(std::string_view path) {
  for (const auto& endpoint : endpoints())
    if (endpoint.path == path) return endpoint.max_body;
  if (path == kBatchesPath) return static_cast<std::size_t>(limit::body_large_max_bytes);
  return static_cast<std::size_t>(limit::body_max_bytes);
}

double budget_s(std::string_view path, const Context& context) {
  if (context.budget_s > 0.0) return context.budget_s;
  for (const auto& endpoint : endpoints())
    if (endpoint.path == path) return endpoint.budget_s;
  return kBudgetS;
}

std::size_t reserved_per_byte(std::string_view path) {
  const auto large = static_cast<std::size_t>(limit::body_large_max_bytes);
  return max_body(path) < large ? kReservedPerByte : kReservedPerByteOfLarge;
}

std::string_view endpoint_at(std::string_view path) {
  for (const auto& endpoint : endpoints())
    if (endpoint.path == path) return endpoint.id;
  return path == kBatchesPath ? kBatchesId : std::string_view{};
}

}  // namespace tubecut::api
