#include "server/machine_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "api/api.hpp"

namespace tubecut::server {

std::string load_machines(const std::string& folder) {
  namespace fs = std::filesystem;
  if (folder.empty()) return {};
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".json") files.push_back(it->path());
  if (error) return folder + ": " + error.message();
  std::sort(files.begin(), files.end());
  std::vector<api::MachineText> texts;
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    texts.push_back({path.string(), {std::istreambuf_iterator<char>(file), {}}});
    if (!file) return path.string() + ": cannot be read";
  }
  return api::set_machines(texts);
}

}  // namespace tubecut::server
