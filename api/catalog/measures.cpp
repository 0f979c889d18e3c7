#include "api/catalog/measures.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tubecut::api {

std::vector<double> measures_in(std::string_view name) {
  for (const auto* standard : {" EN", " ASTM", " A500"}) name = name.substr(0, name.find(standard));
  std::vector<double> out;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (const char* at = name.data(); at != name.data() + name.size();) {
    if (!is_digit(*at)) {
      ++at;
      continue;
    }
    double one = 0.0;
    at = std::from_chars(at, name.data() + name.size(), one).ptr;
    out.push_back(one);
  }
  return out;
}

bool same_measure(double a, double b) { return std::abs(a - b) <= 0.01 * std::max(a, b); }

}  // namespace tubecut::api
