#include "tests/fuzz/dispatch_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tubecut::fuzz::dispatch_bytes({data, size});
  return 0;
}
