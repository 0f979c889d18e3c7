#pragma once

#include <cstdint>
#include <span>

namespace tubecut::fuzz {

/// Reads the bytes as requests of one connection, once whole and once in pieces whose sizes the
/// first byte chooses. Aborts when the two differ, when more is held than allowed, or when a
/// request comes out that should have been refused.
void request_bytes(std::span<const std::uint8_t> bytes);

}  // namespace tubecut::fuzz
