#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tubecut::api {

/// Writes CBOR (RFC 8949, definite lengths, shortest forms) from the events of a JSON text, without
/// a document in between: an answer of a million periods would take sixteen bytes a number.
/// Columns of integers in an object named "counts" become RFC 8746 typed arrays.
class CborWriter {
 public:
  bool null();
  bool boolean(bool v);
  bool integer(std::int64_t v);
  bool number(double v);
  bool text(std::string_view v);
  bool key(std::string_view name);
  bool open(bool object);
  bool close();

  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  struct Frame {
    bool object = false;
    bool counts = false;  // an object named "counts"
    bool column = false;  // an array right in it
    std::uint64_t items = 0;
    std::string bytes = {};
    std::vector<std::int64_t> integers = {};  // of a column, until something else comes
  };

  std::string& here() { return frames_.empty() ? out_ : frames_.back().bytes; }
  void begin_item();
  void give_up_column(Frame& frame);
  [[nodiscard]] static std::string typed_array(const std::vector<std::int64_t>& values);

  std::vector<Frame> frames_;
  std::string key_;
  std::string out_;
};

}  // namespace tubecut::api
