#pragma once

#include <concepts>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "api/json.hpp"
#include "api/stop.hpp"

namespace tubecut::api {

/// Prints results straight into a buffer, without a tree between: columns dominate an answer's
/// cost. Numbers are shortest-round-trip; a number that is not finite throws NotFinite, which
/// becomes a 500. Throws Stopped.
class Writer {
 public:
  struct NotFinite : std::runtime_error {
    using std::runtime_error::runtime_error;
  };

  explicit Writer(std::size_t reserve = 4096, std::stop_token stop = {}) : pace_(std::move(stop)) {
    out_.reserve(reserve);
  }

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
    open('[');
    for (const auto& item : items) {
      separate();
      fresh_ = true;
      each(*this, item);
      fresh_ = false;
    }
    close(']');
  }

  void field(std::string_view name, double value);
  template <std::integral T>
  requires(!std::same_as<T, bool>) void field(std::string_view name, T value) {
    key(name);
    out_ += std::to_string(value);
    fresh_ = false;
  }
  void field(std::string_view name, std::same_as<bool> auto value) {
    key(name);
    out_ += value ? "true" : "false";
    fresh_ = false;
  }
  void field(std::string_view name, std::string_view value);
  void field(std::string_view name, const char* value) { field(name, std::string_view(value)); }
  void field(std::string_view name, const std::string& value) {
    field(name, std::string_view(value));
  }
  void field(std::string_view name, const Json& value) { raw(name, dump(value, pace_.stop())); }
  void degrees(std::string_view name, double radians);

  void column(std::string_view name, std::span<const double> values);
  void column(std::string_view name, const std::vector<double>& values) {
    column(name, std::span<const double>(values));
  }
  /// Radians inside, degrees on the wire.
  void degrees_column(std::string_view name, std::span<const double> radians);
  template <std::integral T>
  void column(std::string_view name, const std::vector<T>& values) {
    list(name, values, [this](T v) { out_ += std::to_string(v); });
  }
  void column(std::string_view name, const std::vector<std::string>& values) {
    list(name, values, [this](const std::string& v) { append_text(out_, v); });
  }

  void flags(std::string_view name, const std::vector<bool>& values) {
    list(name, values, [this](bool v) { out_ += v ? "true" : "false"; });
  }

  /// Text that is JSON already.
  void raw(std::string_view name, std::string_view json);
  /// An element of an array.
  void value(double number);
  void value(std::string_view text);

  [[nodiscard]] std::string take() { return std::move(out_); }
  [[nodiscard]] const std::string& text() const { return out_; }

 private:
  void separate() {
    pace_.turn();
    if (!fresh_) out_ += ',';
    fresh_ = false;
  }
  void key(std::string_view name);
  void open(char c) {
    out_ += c;
    fresh_ = true;
  }
  void close(char c) {
    out_ += c;
    fresh_ = false;
  }
  void finite(double value, std::string_view name);
  template <class Values, class F>
  void list(std::string_view name, const Values& values, F each) {
    key(name);
    open('[');
    for (const auto& v : values) {
      separate();
      each(v);
    }
    close(']');
  }

  std::string out_;
  Pace pace_;
  bool fresh_ = true;
};

}  // namespace tubecut::api
