#include "server/machine_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "api/api.hpp"

namespace tubecut::server {

namespace {

using Set = std::string (*)(std::span<const api::FileText>);

std::string load(const std::string& folder, Set set) {
  namespace fs = std::filesystem;
  if (folder.empty()) return {};
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".json") files.push_back(it->path());
  if (error) return folder + ": " + error.message();
  std::sort(files.begin(), files.end());
  std::vector<api::FileText> texts;
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    texts.push_back({path.string(), {std::istreambuf_iterator<char>(file), {}}});
    if (!file) return path.string() + ": cannot be read";
  }
  return set(texts);
}

}  // namespace

std::string load_machines(const std::string& folder) { return load(folder, api::set_machines); }

std::string load_posts(const std::string& folder) { return load(folder, api::set_posts); }

}  // namespace tubecut::server
