#pragma once

#include <string_view>
#include <vector>

namespace tubecut::api {

/// One element of a header whose value is a list, such as `text/csv;header=present;q=0.5`.
struct ListElement {
  std::string_view name;  // as sent, without its parameters
  double quality = 1.0;   // of its parameter q, 0 to 1; 0 if it is not valid
};

/// Returns the elements in their order, without surrounding blanks and without empty ones.
/// Source  RFC 9110, 5.6.1 and 12.4.2.
[[nodiscard]] std::vector<ListElement> header_list(std::string_view value);

}  // namespace tubecut::api
