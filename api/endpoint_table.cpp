#include "api/endpoint.hpp"
#include "api/endpoints/all.hpp"

namespace tubecut::api {

std::span<const Endpoint> endpoints() {
  static const std::vector<Endpoint> kTable{
      intersections(),
      bevel_tables(),
      holes(),
      feed_curves(),
  };
  return kTable;
}

}  // namespace tubecut::api
