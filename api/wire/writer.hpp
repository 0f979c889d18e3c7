#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "api/stop.hpp"
#include "api/wire/cbor.hpp"
#include "api/wire/json.hpp"
#include "api/wire/sha256.hpp"

namespace tubecut::api {

enum class Encoding { json, cbor };

/// Prints results straight into a buffer, without a tree between: columns dominate an answer's
/// cost. JSON has no white space and shortest-round-trip numbers; CBOR is the same document, order
/// kept (cbor.hpp). A number that is not finite throws NotFinite, which becomes a 500. Throws
/// Stopped.
class Writer {
 public:
  struct NotFinite : std::runtime_error {
    using std::runtime_error::runtime_error;
  };

  explicit Writer(std::size_t reserve = 4096, Encoding encoding = Encoding::json);

  /// Returns a writer of JSON that keeps only its sha256.
  static Writer hashing();

  template <class F>
  void object(F body) {
    open('{');
    body(*this);
    close('}');
  }
  template <class F>
  void object(std::string_view name, F body) {
    key(name);
    object(body);
  }
  /// One element per item, written by `each(writer, item)`.
  template <class Items, class F>
  void array(std::string_view name, const Items& items, F each) {
    key(name);
    list(items, [&](const auto& item) { each(*this, item); });
  }

  void field(std::string_view name, double value);
  template <std::integral T>
  requires(!std::same_as<T, bool>) void field(std::string_view name, T value) {
    key(name);
    integer(static_cast<std::int64_t>(value));
  }
  void field(std::string_view name, std::same_as<bool> auto value) {
    key(name);
    boolean(value);
  }
  template <std::convertible_to<std::string_view> T>
  void field(std::string_view name, const T& text) {
    key(name);
    value(std::string_view(text));
  }
  void field(std::string_view name, const Json& value);
  void degrees(std::string_view name, double radians);

  void column(std::string_view name, std::span<const double> values);
  void column(std::string_view name, const std::vector<double>& values) {
    column(name, std::span<const double>(values));
  }
  /// Radians inside, degrees on the wire.
  void degrees_column(std::string_view name, std::span<const double> radians);
  template <std::integral T>
  void column(std::string_view name, const std::vector<T>& values);
  void column(std::string_view name, const std::vector<std::string>& values);
  void flags(std::string_view name, const std::vector<bool>& values);

  /// Hashes the output of `body` without keeping it: for columns that are not requested.
  template <class F>
  void unseen(F body) {
    if (cbor_) return;  // only JSON is hashed
    const Cut cut{.from = out_.size(), .first = fresh_};
    body(*this);
    leave_out(cut);
  }

  /// Returns a writer for an element that is inserted later: several may be written at a time.
  [[nodiscard]] Writer part() const;
  void put(Writer part);

  /// Writes a value that is already in this writer's encoding.
  void raw(std::string_view name, std::string_view encoded);
  /// An element of an array.
  void value(double number);
  void value(std::string_view text);
  /// An element, or the whole document.
  void json(const Json& value);

  [[nodiscard]] std::string take();
  /// Of all that was written as JSON, in lower-case hex. Before it is taken.
  [[nodiscard]] std::string sha256();

 private:
  void separate() {
    pace_.tick();
    if (out_.size() >= kHashed && hash_) hash_so_far();
    if (!fresh_ && !cbor_) out_ += ',';
    fresh_ = false;
  }
  static constexpr std::size_t kHashed = 1u << 16;  // bytes at once
  static constexpr std::size_t kItemBytes = 128;    // most names and items have less
  void hash_so_far();
  /// A range of out_ to omit.
  struct Cut {
    std::size_t from = 0, to = 0;
    bool first = false;  // of its object: the comma behind it goes with it
  };
  void leave_out(Cut cut);
  void key(std::string_view name);
  void open(char c);
  void close(char c);
  void number(double value, std::string_view name);
  void numbers(std::string_view name, std::span<const double> values, double unit);
  template <class Values, class F>
  void straight(const Values& values, F print);
  void integer(std::int64_t value);
  void boolean(bool value);
  void null();
  template <class Items, class F>
  void list(const Items& items, F each) {
    open('[');
    for (const auto& item : items) {
      separate();
      fresh_ = true;
      each(item);
      fresh_ = false;
    }
    close(']');
  }

  std::string out_;
  std::vector<Cut> cuts_;
  std::optional<CborWriter> cbor_;  // instead of out_
  std::optional<Sha256> hash_;      // of the previous content of out_
  Pace pace_;
  bool fresh_ = true;
};

/// The document as JSON.
[[nodiscard]] std::string dump(const Json& json);

}  // namespace tubecut::api
