#include "tests/support/golden.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace tubecut::testing {

std::string read_project_file(std::string_view path) {
  const auto full = std::string(TUBECUT_SOURCE_DIR) + "/" + std::string(path);
  std::ifstream file(full, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.empty()) throw std::runtime_error("missing or empty: " + full);
  return text;
}

api::Json golden(std::string_view file) {
  auto parsed = api::parse(read_project_file("tests/golden/" + std::string(file)));
  if (!parsed)
    throw std::runtime_error(std::string(file) + ": " + parsed.error().reason + " at byte " +
                             std::to_string(parsed.error().offset));
  return *std::move(parsed);
}

const api::Json& at(const api::Json& json, std::string_view path) {
  const api::Json* here = &json;
  auto rest = path;
  while (!rest.empty()) {
    const auto slash = rest.find('/');
    const auto step = rest.substr(0, slash);
    rest = slash == std::string_view::npos ? std::string_view{} : rest.substr(slash + 1);
    if (const auto* array = here->as<api::Json::Array>()) {
      here = &array->at(std::stoul(std::string(step)));
    } else {
      here = here->find(step);
    }
    if (here == nullptr) throw std::out_of_range("no " + std::string(path));
  }
  return *here;
}

double number(const api::Json& json, std::string_view path) {
  const auto& node = at(json, path);
  if (const auto* d = node.as<double>()) return *d;
  if (const auto* s = node.as<std::string>()) return std::strtod(s->c_str(), nullptr);
  throw std::out_of_range("not a number: " + std::string(path));
}

std::string text(const api::Json& json, std::string_view path) {
  const auto* s = at(json, path).as<std::string>();
  if (s == nullptr) throw std::out_of_range("not a text: " + std::string(path));
  return *s;
}

std::vector<double> numbers(const api::Json& json, std::string_view path) {
  const auto* array = at(json, path).as<api::Json::Array>();
  if (array == nullptr) throw std::out_of_range("not an array: " + std::string(path));
  std::vector<double> out;
  out.reserve(array->size());
  for (const auto& item : *array) out.push_back(number(item));
  return out;
}

}  // namespace tubecut::testing
