#include "api/api.hpp"

namespace tubecut::api {

/// Replaces api/version.cpp: the next engine, for tests of a fleet with both.
std::string_view version() { return "next"; }

int numerics() { return 1000; }

}  // namespace tubecut::api
