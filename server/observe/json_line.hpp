#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace tubecut::server {

inline constexpr std::size_t kLongestLine = 16384;

/// One JSON object on one line, written member by member in the order of the calls. At most
/// kLongestLine bytes, however long the texts: what is left out is counted in its member
/// `left_out`.
class JsonLine {
 public:
  JsonLine& text(std::string_view name, std::string_view value);
  JsonLine& integer(std::string_view name, std::int64_t value);
  /// A time in ms, three decimals.
  JsonLine& milliseconds(std::string_view name, double seconds);
  JsonLine& open(std::string_view name, char bracket);
  JsonLine& item(std::string_view value);
  JsonLine& close(char bracket);
  [[nodiscard]] std::string done();

 private:
  void separate();
  void key(std::string_view name);
  void quote(std::string_view value);
  [[nodiscard]] bool full();

  std::string x_ = "{";
  std::int64_t left_out_ = 0;  // texts, whole or in part
};

}  // namespace tubecut::server
