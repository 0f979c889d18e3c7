// Runs every file of a corpus through the fuzzer's own function, without libFuzzer: replay FOLDER.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "api/api.hpp"
#include "api/batch.hpp"
#include "api/endpoint.hpp"
#include "tests/fuzz/dispatch_bytes.hpp"

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < argc; ++i)
    for (const auto& entry : std::filesystem::directory_iterator(argv[i]))
      if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::set<std::string_view> asked;  // by more than a stray byte
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
    std::printf("%s: %zu bytes\n", path.filename().c_str(), bytes.size());
    std::fflush(stdout);  // so that the last name is there when it aborts
    tubecut::fuzz::dispatch_bytes(bytes);
    if (bytes.size() > 3) asked.emplace(tubecut::fuzz::endpoint_of(bytes));
  }
  std::printf("%zu inputs\n", files.size());
  bool all = !files.empty();
  std::vector<std::string_view> ids = {tubecut::api::kBatchesId};
  for (const auto& endpoint : tubecut::api::endpoints()) ids.push_back(endpoint.id);
  for (const auto id : ids) {
    if (asked.contains(id)) continue;
    std::printf("no input asks %s\n", std::string(id).c_str());
    all = false;
  }
  return all ? 0 : 1;
}
