#include "api/endpoint.hpp"
#include "api/endpoints/all.hpp"

namespace tubecut::api {

std::span<const Endpoint> endpoints() {
  static const std::vector<Endpoint> kTable{
      intersections(),   nodes(),   bevel_tables(), holes(),   parts(),
      pulse_schedules(), replays(), feed_curves(),  grooves(), mill_paths(),
  };
  return kTable;
}

}  // namespace tubecut::api
