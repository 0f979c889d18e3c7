#pragma once

#include "core/joint/node.hpp"

/// For `solve` only.
namespace tubecut::joint::detail {

/// Sets open, consumed and the ghosts of one end; the scan is left out where bounds already say
/// that there is nothing to find.
void inspect(const NodeSpec& spec, MemberEnd& end);

}  // namespace tubecut::joint::detail
