#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/stop.hpp"
#include "api/wire/field_names.hpp"
#include "api/wire/json.hpp"
#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/base/names.hpp"

namespace tubecut::api {

/// The numbers a field may hold.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;
  bool open_max = false;
};
inline constexpr Range kNotNegative{.min = 0.0};

struct CountRange {
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();
  std::string_view instead = {};  // the way for more
};

/// One thing wrong with a request, as the caller sees it.
struct FieldIssue {
  ErrorCode code = ErrorCode::out_of_range;
  std::string pointer = {};  // JSON pointer, RFC 6901
  Json got = {};
  Json limit = {};
  std::string unit = {};
  std::string hint = {};
};

/// Reads one object of a request: the only reader of request fields.
///
/// Checks every field that is read (type, finite, range, unit) and echoes it with defaults applied;
/// a field that is never read is an issue. Collects all issues; if there is an issue, a getter
/// returns a harmless value. Degrees become radians here and nowhere else.
class Reader {
 public:
  explicit Reader(const Json& body);

  [[nodiscard]] const Json* find(std::string_view name) const { return body_->find(name); }
  [[nodiscard]] bool has(std::string_view name) const { return find(name) != nullptr; }
  template <class T>
  [[nodiscard]] bool is(std::string_view name) const {
    const auto* field = find(name);
    return field != nullptr && field->as<T>() != nullptr;
  }

  /// Returns whether the request has any issue so far.
  [[nodiscard]] bool refused() const { return !issues_->empty(); }
  /// Returns whether the field has been read, or its default taken, without an issue of its own.
  [[nodiscard]] bool understood(std::string_view name) const;
  /// Returns whether no issue is known of the field, nor of anything within it.
  [[nodiscard]] bool sound(std::string_view name) const;

  double number(std::string_view name, Range range = {}, std::optional<double> fallback = {});
  std::optional<double> optional_number(std::string_view name, Range range = {});
  int integer(std::string_view name, int min, int max, std::optional<int> fallback = {});
  bool flag(std::string_view name, std::optional<bool> fallback = {});
  /// Printable text of 1 to `longest` characters. `fallback` empty: required.
  /// One to `longest` characters (text_encoding.hpp).
  std::string text(std::string_view name, std::size_t longest = 64);
  /// Reads printable ASCII that becomes a word of a program.
  std::string ascii_text(std::string_view name, std::size_t longest);
  std::optional<std::string> optional_text(std::string_view name, std::size_t longest = 64);
  /// A field ending in `_deg` (range in degrees) or `_rad` (range in radians).
  Angle angle(std::string_view name, Range range = {}, std::optional<Angle> fallback = {});
  std::optional<Angle> optional_angle(std::string_view name, Range range = {});
  /// `stem_deg` or `stem_rad`, exactly one of them; `range` in radians.
  Angle angle_either(std::string_view stem, Range range);

  std::vector<double> column(std::string_view name, CountRange count, Range range = {});
  std::vector<double> angle_column(std::string_view name, CountRange count, Range range = {});
  std::vector<bool> flag_column(std::string_view name, CountRange count);
  /// Reads printable texts of 1 to `longest` characters; if there is an issue, the text is empty.
  std::vector<std::string> text_column(std::string_view name, CountRange count,
                                       std::size_t longest = 64);
  Eigen::Vector3d vector3(std::string_view name, Range range = {});
  /// An array of [first, second].
  std::vector<std::pair<double, double>> pairs(std::string_view name, CountRange count, Range first,
                                               Range second);
  /// Reads a number, or null; nothing if null or absent.
  std::optional<double> nullable_number(std::string_view name, Range range);
  /// True, and echoed, when the member is null.
  bool is_null(std::string_view name);

  template <class E, std::size_t N>
  E choice(std::string_view name, const std::array<Option<E>, N>& options,
           std::optional<std::type_identity_t<E>> fallback = {}) {
    std::vector<std::string_view> names;
    for (const auto& option : options) names.push_back(option.name);
    std::optional<std::size_t> back;
    for (std::size_t i = 0; fallback && i < N; ++i)
      if (options[i].value == *fallback) back = i;
    const auto index = choose(name, names, back);
    return index ? options[*index].value : options[0].value;
  }

  template <Named E>
  E choice(std::string_view name, E fallback) {
    return choice(name, kNames<E>, fallback);
  }

  /// Reads the choice that determines the other members. If it is not valid, this object reports no
  /// more issues.
  template <class E, std::size_t N>
  std::optional<E> tag(std::string_view name, const std::array<Option<E>, N>& options) {
    const auto value = choice(name, options);
    silent_ = !understood(name);
    return silent_ ? std::nullopt : std::optional<E>(value);
  }

  /// Returns the only one of these members that is present; if there is not exactly one, returns
  /// nothing and reports an issue at each.
  std::optional<std::size_t> exactly_one(std::initializer_list<std::string_view> names);

  /// A nested object, read by `decode(Reader&)`; required.
  template <class F>
  auto object(std::string_view name, F decode) -> std::invoke_result_t<F, Reader&> {
    std::invoke_result_t<F, Reader&> out{};
    if (const auto* field = required_container(name, true)) {
      Reader child = nested(*field, std::string(name));
      out = decode(child);
      adopt(name, child);
    }
    return out;
  }

  template <class F>
  auto optional_object(std::string_view name, F decode)
      -> std::optional<std::invoke_result_t<F, Reader&>> {
    note(name);
    if (!has(name)) return std::nullopt;
    return object(name, decode);
  }

  /// Reads absent objects as empty ones, so that their defaults are echoed.
  template <class F>
  auto defaulted_object(std::string_view name, F decode) -> std::invoke_result_t<F, Reader&> {
    static const Json kEmpty{Json::Object{}};
    note(name);
    if (has(name)) return object(name, decode);
    Reader child = nested(kEmpty, std::string(name));
    auto out = decode(child);
    adopt(name, child);
    return out;
  }

  template <class F>
  auto array(std::string_view name, CountRange count, F decode)
      -> std::vector<std::invoke_result_t<F, Reader&>> {
    std::vector<std::invoke_result_t<F, Reader&>> out;
    const auto* items = required_array(name, count);
    if (items == nullptr) return out;
    Json::Array echoes;
    for (std::size_t i = 0; i < items->size(); ++i) {
      ask();
      const auto step = std::string(name) + "/" + std::to_string(i);
      if ((*items)[i].template as<Json::Object>() == nullptr) {
        issue({.code = ErrorCode::wrong_type, .pointer = step, .hint = "an object is required"},
              &(*items)[i]);
        continue;
      }
      Reader child = nested((*items)[i], step);
      out.push_back(decode(child));
      child.finish();
      echoes.push_back(Json{std::move(child.echo_)});
    }
    put(name, Json{std::move(echoes)});
    return out;
  }

  /// Marks a name as known without reading it (it belongs to the request, another reader takes it).
  [[nodiscard]] const Json& body() const { return *body_; }
  void note(std::string_view name);
  /// Records an issue; `issue.pointer` is relative to this object, `got` is taken from `value` when
  /// given.
  void issue(FieldIssue issue, const Json* value = nullptr);
  /// This object reports no more issues.
  void silence() { silent_ = true; }

  /// Reports the fields that were never read and returns all issues; call once, at the root.
  [[nodiscard]] std::vector<FieldIssue> finish_root();
  [[nodiscard]] const Json::Object& echo() const { return echo_; }
  /// The echo, which may be large, given away; for when all is read.
  [[nodiscard]] Json::Object take_echo() { return std::move(echo_); }
  void put(std::string_view name, Json value);
  /// Removes a member from the echo and returns it; null when it is not there.
  Json take_echo(std::string_view name);

  /// Whether the answer goes out in a binary format, which may be longer. Set at the root.
  void set_binary(bool binary) { binary_ = binary; }
  [[nodiscard]] bool binary() const { return binary_; }

 private:
  Reader(const Json& body, std::string pointer, std::vector<FieldIssue>* issues)
      : body_(&body), pointer_(std::move(pointer)), issues_(issues) {}
  [[nodiscard]] Reader nested(const Json& body, const std::string& step) const {
    Reader child(body, pointer_ + "/" + step, issues_);
    child.binary_ = binary_;
    child.silent_ = silent_;
    child.pace_ = pace_;
    return child;
  }
  void adopt(std::string_view name, Reader& child);
  void record(FieldIssue issue, const Json* value);
  void finish();
  const Json* required(std::string_view name, std::string_view wanted);
  const Json* required_container(std::string_view name, bool object);
  const Json::Array* required_array(std::string_view name, CountRange count);
  std::optional<std::size_t> choose(std::string_view name, std::span<const std::string_view> names,
                                    std::optional<std::size_t> fallback);
  std::optional<double> checked(std::string_view name, const Json& value, Range range,
                                const std::string& step);

  const Json* body_;
  std::string pointer_;
  std::vector<FieldIssue> own_issues_;  // of the root only
  std::vector<FieldIssue>* issues_;
  std::vector<std::string> known_;
  Json::Object echo_;
  Pace pace_;
  bool binary_ = false;
  bool silent_ = false;
};

}  // namespace tubecut::api
