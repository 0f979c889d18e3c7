#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/reader.hpp"
#include "api/writer.hpp"
#include "core/motion/machine.hpp"

namespace tubecut::api {

/// A machine that requests can name.
struct ShelfMachine {
  motion::Machine machine;
  std::vector<motion::Provenance> values;  // of built-in machines: where each number comes from
  std::string sha256;                      // over the JSON that encode_machine prints
};

/// The built-in machines and those added at start, in that order.
[[nodiscard]] std::span<const ShelfMachine> machines();
[[nodiscard]] const ShelfMachine* find_machine(std::string_view name);

/// `in` stands on an object in the form of GET /v1/machines.
[[nodiscard]] motion::Machine decode_machine(Reader& in);
void encode_machine(const motion::Machine& machine, Writer& w);
[[nodiscard]] std::string machine_sha256(const motion::Machine& machine);

/// A field that is a machine's name, or a machine.
[[nodiscard]] motion::Machine decode_machine_choice(Reader& in, std::string_view name);

/// GET /v1/machines.
[[nodiscard]] std::string machines_page();

}  // namespace tubecut::api
