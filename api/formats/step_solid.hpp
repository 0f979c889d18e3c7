#pragma once

#include <string>

#include "api/format.hpp"
#include "api/formats/tube_solid.hpp"

namespace tubecut::api {

/// What the file calls a solid.
struct Product {
  std::string id, name, revision;
};

/// A product of AP214 whose shape is the solid, in mm: its walls grey, its cuts of a colour of
/// their own, each face by its name. Head and product carry the job, the reference, both hashes and
/// the verdict.
[[nodiscard]] std::string print_step(const TubeSolid& solid, const Product& product,
                                     const Caption& caption);

}  // namespace tubecut::api
