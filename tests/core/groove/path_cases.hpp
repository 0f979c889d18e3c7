#pragma once

#include "core/groove/mill_path.hpp"
#include "tests/core/groove/mill_cases.hpp"

namespace tubecut::groove::testing {

inline MillPathSpec path_case(const std::string& name, Hold hold) {
  MillPathSpec out;
  out.groove = groove_case(name);
  out.mill = mill_case(name);
  out.setup = setup_case(name);
  out.optimise.hold = hold;
  return out;
}

inline MillPathSpec path_case(const std::string& name) { return path_case(name, hold_case(name)); }

inline std::vector<Block> emitted_blocks(const MillPath& path) {
  std::vector<Block> out;
  for (const MillPosition& p : path.positions)
    out.push_back({p.omega.rad(), p.at.x, p.at.z, p.at.b.rad()});
  return out;
}

}  // namespace tubecut::groove::testing
