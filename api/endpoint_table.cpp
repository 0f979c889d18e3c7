#include "api/endpoint.hpp"

namespace tubecut::api {

std::span<const Endpoint> endpoints() {
  static const std::vector<Endpoint> kTable{
  };
  return kTable;
}

}  // namespace tubecut::api
