#pragma once

#include <bit>
#include <cstring>
#include <string>

namespace tubecut::api {

static_assert(std::endian::native == std::endian::little, "glTF and STL are little endian");

/// Appends the bytes of a number as in memory.
template <class T>
void append_bytes(std::string& out, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  out.append(raw, sizeof(T));
}

}  // namespace tubecut::api
