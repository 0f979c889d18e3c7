#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tubecut::api {

/// Writes CBOR (RFC 8949, definite lengths, shortest forms) item by item, without a document in
/// between: an answer of a million periods would take sixteen bytes a number. Columns of integers
/// in an object named "counts" become RFC 8746 typed arrays (tag 77, int16 little endian; tag 78,
/// int32, where a value does not fit).
class CborWriter {
 public:
  void null();
  void boolean(bool v);
  void integer(std::int64_t v);
  /// A whole number within 2^53 is an integer; `v` must be finite.
  void number(double v);
  void text(std::string_view v);
  /// One item that is CBOR already.
  void raw(std::string_view item);
  void key(std::string_view name);
  void open(bool object);
  void close();

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
