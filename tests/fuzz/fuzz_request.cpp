#include "tests/fuzz/request_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tubecut::fuzz::request_bytes({data, size});
  return 0;
}
