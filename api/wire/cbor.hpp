#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/stop.hpp"

namespace tubecut::api {

/// Writes CBOR (RFC 8949, definite lengths, shortest forms) item by item, without an intermediate
/// document, because an answer of a million periods would take sixteen bytes per number. Columns of
/// integers in an object named "counts" are RFC 8746 typed arrays (tag 77, int16 little endian; tag
/// 78, int32, if a value does not fit). Throws Stopped if cancelled.
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

  /// Right in an object named "counts".
  [[nodiscard]] bool in_counts() const { return !frames_.empty() && frames_.back().counts; }
  /// A column of such an object.
  void typed_array(std::span<const std::int32_t> values);

  [[nodiscard]] std::string take();

 private:
  struct Frame {
    bool object = false;
    bool counts = false;  // an object named "counts"
    std::uint64_t items = 0;
    std::size_t at = 0;  // its head's first byte
  };
  /// The rest of a head longer than the byte left for it, to be put in before `at`.
  struct Rest {
    std::size_t at = 0;
    std::string bytes;
  };

  static constexpr std::size_t kHeadBytes = 9;  // at most, of an item
  void begin_item() {
    if (!frames_.empty() && !frames_.back().object) ++frames_.back().items;
  }

  std::vector<Frame> frames_;
  std::vector<Rest> rests_;
  std::string key_;
  std::string out_;
};

}  // namespace tubecut::api
