#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tubecut::server {

/// One JSON object on one line, written member by member in the order of the calls.
class JsonLine {
 public:
  JsonLine& text(std::string_view name, std::string_view value);
  JsonLine& integer(std::string_view name, std::int64_t value);
  /// A time in ms, three decimals.
  JsonLine& milliseconds(std::string_view name, double seconds);
  JsonLine& open(std::string_view name, char bracket);
  JsonLine& item(std::string_view value);
  JsonLine& close(char bracket);
  [[nodiscard]] std::string done() { return x_ + '}'; }

 private:
  void separate();
  void key(std::string_view name);
  void quote(std::string_view value);

  std::string x_ = "{";
};

}  // namespace tubecut::server
