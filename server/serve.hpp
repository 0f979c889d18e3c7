#pragma once

#include "server/config.hpp"

namespace tubecut::server {

/// Runs the service until SIGTERM or SIGINT. Returns the process's exit code: 0 after a clean stop.
[[nodiscard]] int serve(const Config& config) noexcept;

/// Checks whether the service of that configuration, on this machine, is ready. Returns 0 if it is.
[[nodiscard]] int health(const Config& config);

/// Answers one request file on stdout with the bytes the service would send. 0: an answer, 1: a
/// problem.
[[nodiscard]] int run(const Command& command);

}  // namespace tubecut::server
