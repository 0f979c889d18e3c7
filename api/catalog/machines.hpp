#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/catalog/process.hpp"
#include "api/wire/reader.hpp"
#include "api/wire/writer.hpp"
#include "core/motion/machine/machine.hpp"

namespace tubecut::api {

/// A machine that requests can name.
struct ShelfMachine {
  motion::Machine machine;
  std::vector<motion::Provenance> values;  // for built-in machines: the source of each number
  std::string sha256;                      // over the JSON that encode_machine prints
  std::optional<Process> process = {};
  std::string process_sha256 = {};  // separate, because tuning it moves no axis
};

using Shelf = std::vector<ShelfMachine>;

/// Returns the built-in machines and those of `set_machines`, in that order, as they are now. If
/// you need them twice within a job, keep the pointer, because the next call may return another
/// shelf.
[[nodiscard]] std::shared_ptr<const Shelf> machines();

/// Decodes an object in the form of GET /v1/machines at `in`: the motion. If it has a process
/// table, checks it.
[[nodiscard]] motion::Machine decode_machine(Reader& in);
void encode_machine(const motion::Machine& machine, Writer& w);
[[nodiscard]] std::string machine_sha256(const motion::Machine& machine);
/// The member `machines`: name and hashes of each.
void encode_machine_hashes(Writer& w);

/// Decodes a field with a machine's name, or a machine, and the `machine_sha256` next to it, which
/// pins its content. For a name, the echo contains that hash, so that the machine is part of a
/// job's identity.
[[nodiscard]] motion::Machine decode_machine_choice(Reader& in, std::string_view name);

/// GET /v1/machines.
[[nodiscard]] std::string machines_page();

}  // namespace tubecut::api
