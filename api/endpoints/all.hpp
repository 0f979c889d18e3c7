#pragma once

#include "api/endpoint.hpp"

namespace tubecut::api {

// One line per endpoint; the table in endpoint_table.cpp lists them in the order of the contract.
[[nodiscard]] Endpoint intersections();
[[nodiscard]] Endpoint nodes();
[[nodiscard]] Endpoint bevel_tables();
[[nodiscard]] Endpoint holes();
[[nodiscard]] Endpoint parts();
[[nodiscard]] Endpoint frames();
[[nodiscard]] Endpoint pulse_schedules();
[[nodiscard]] Endpoint replays();
[[nodiscard]] Endpoint feed_curves();
[[nodiscard]] Endpoint grooves();
[[nodiscard]] Endpoint mill_paths();

}  // namespace tubecut::api
