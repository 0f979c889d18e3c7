// Runs every file of a corpus of requests through the fuzzer's own function: replay_request FOLDER.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/request_bytes.hpp"

int main(int argc, char** argv) {
  std::size_t inputs = 0;
  for (int i = 1; i < argc; ++i) {
    for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
      std::ifstream file(entry.path(), std::ios::binary);
      std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
      std::printf("%s\n", entry.path().filename().c_str());
      std::fflush(stdout);
      if (bytes.empty()) continue;
      for (int piece = 0; piece < 16; ++piece) {  // in pieces of every size
        bytes[0] = static_cast<std::uint8_t>(piece);
        tubecut::fuzz::request_bytes(bytes);
      }
      ++inputs;
    }
  }
  std::printf("%zu inputs\n", inputs);
  return inputs == 0 ? 1 : 0;
}
