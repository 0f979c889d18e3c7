#pragma once

#include "api/formats/gcode/gcode.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// What the request's machine says of its torch, wherever the request says nothing itself: the row
/// of the material for the thickest metal that the beam goes through. The job's header tells what
/// was taken and what goes before it.
///
/// Errors  throws UnfitOption: material, where the table does not reach as thick; machine, where its
///         name has no spelling in a program.
void take_process(TorchJob& job, FormatOptions& options, const std::stop_token& stop);

}  // namespace tubecut::api
