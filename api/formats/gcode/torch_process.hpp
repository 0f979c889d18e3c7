#pragma once

#include "api/formats/gcode/gcode.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// Takes torch values from the request's machine if the request does not set them: the row of the
/// material for the thickest metal in the beam. The job's header states the taken values and the
/// overriding ones.
///
/// Errors  throws UnfitOption: material, if the metal is thicker than the table; machine, if its
///         name has no spelling in a program.
void take_process(TorchJob& job, FormatOptions& options);

}  // namespace tubecut::api
