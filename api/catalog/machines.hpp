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
  std::vector<motion::Provenance> values;  // of built-in machines: where each number comes from
  std::string sha256;                      // over the JSON that encode_machine prints
  std::optional<Process> process = {};
  std::string process_sha256 = {};  // apart: what is tuned in it moves no axis
};

using Shelf = std::vector<ShelfMachine>;

/// The built-in machines and those of `set_machines`, in that order, as they are now. Who looks
/// twice within a job keeps what was got: the next look may find another shelf.
[[nodiscard]] std::shared_ptr<const Shelf> machines();

/// `in` stands on an object in the form of GET /v1/machines. What moves; its process table, if it
/// has one, is checked.
[[nodiscard]] motion::Machine decode_machine(Reader& in);
void encode_machine(const motion::Machine& machine, Writer& w);
[[nodiscard]] std::string machine_sha256(const motion::Machine& machine);
/// The member `machines`: name and hashes of each.
void encode_machine_hashes(Writer& w);

/// A field that is a machine's name, or a machine, and beside it `machine_sha256`, which pins what
/// it holds. Of a name the echo says that hash, so that a job's identity takes the machine in.
[[nodiscard]] motion::Machine decode_machine_choice(Reader& in, std::string_view name);

/// GET /v1/machines.
[[nodiscard]] std::string machines_page();

}  // namespace tubecut::api
