#include "api/api.hpp"

namespace tubecut::api {

std::string_view version() { return TUBECUT_VERSION; }

int numerics() { return 11; }

}  // namespace tubecut::api
