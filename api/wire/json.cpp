#include "api/wire/json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "api/stop.hpp"
#include "api/wire/json_number.hpp"
#include "api/wire/shortest.hpp"

namespace tubecut::api {
namespace {

/// How far the bytes are read. A single text of a body may take longer than a stop waits.
struct Progress {
  static constexpr std::ptrdiff_t kAskEvery = 16384;
  const char* at;
  const char* ask_at;
  const char* end;

  void reach(const char* place) {
    at = place;
    if (at < ask_at) return;
    ask();
    ask_at = at + kAskEvery;
  }
};

constexpr std::size_t kLong = 4096;  // elements or members that are moved or freed in no time

/// Returns the number of elements or members of each container with more than kLong, by its number
/// in the order of opening. If the bytes are not JSON, or deeper than `depth`, the result may be
/// wrong.
std::map<std::size_t, std::size_t> long_containers(Progress progress, const char* at,
                                                   std::size_t depth) {
  std::map<std::size_t, std::size_t> out;
  progress.ask_at = at;
  std::vector<std::pair<std::size_t, std::size_t>> open;  // number, commas until now
  bool in_text = false;
  for (std::size_t opened = 0; at != progress.end; ++at) {
    progress.reach(at);
    if (*at == '"') {
      in_text = !in_text;
    } else if (in_text) {
      if (*at == '\\' && ++at == progress.end) return out;
    } else if (*at == ',') {
      if (!open.empty()) ++open.back().second;
    } else if (*at == '[' || *at == '{') {
      if (open.size() == depth) return out;
      open.emplace_back(opened++, 0);
    } else if (*at == ']' || *at == '}') {
      if (open.empty()) return out;
      if (open.back().second >= kLong) out.emplace(open.back().first, open.back().second + 1);
      open.pop_back();
    }
  }
  return out;
}

/// Walks bytes and reports its progress, so that a SAX callback knows its offset.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, Progress* progress) : at_(at), progress_(progress) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    progress_->reach(++at_);
    return *this;
  }
  CountingIterator operator++(int) {
    auto before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) {
    return a.at_ == b.at_;
  }

 private:
  const char* at_;
  Progress* progress_;
};

/// Builds a Json from SAX events and refuses the errors that a lenient parser permits.
class Builder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(std::size_t depth, const char* begin, const Progress* progress)
      : depth_(depth), begin_(begin), progress_(progress) {}

  bool null() override { return put(Json{}); }
  bool boolean(bool v) override { return put(Json{v}); }
  bool number_integer(number_integer_t v) override {
    constexpr std::int64_t kExact = std::int64_t{1} << 53;
    if (v < -kExact || v > kExact) return refuse("integer beyond 2^53");
    return put(Json{static_cast<double>(v)});
  }
  bool number_unsigned(number_unsigned_t v) override {
    if (v > (std::uint64_t{1} << 53)) return refuse("integer beyond 2^53");
    return put(Json{static_cast<double>(v)});
  }
  bool number_float(number_float_t v, const string_t& text) override {
    if (const auto fault = number_fault(v, text)) return refuse(fault->reason);
    return put(Json{v});
  }
  bool string(string_t& v) override { return put(Json{std::move(v)}); }
  bool binary(binary_t& /*unused*/) override { return refuse("binary value"); }
  bool start_object(std::size_t /*unused*/) override { return open(Json{Json::Object{}}); }
  bool start_array(std::size_t /*unused*/) override { return open(Json{Json::Array{}}); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& v) override {
    auto& object = *stack_.back().as<Json::Object>();
    if (!keys_.back().insert(v).second) return refuse("duplicate key");
    make_room(object);
    // In its place: of one moved in, g++ 12 warns as at put.
    object.emplace_back(std::piecewise_construct, std::forward_as_tuple(std::move(v)),
                        std::forward_as_tuple());
    return true;
  }
  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& error) override {
    // what() contains the client's raw bytes, so only the class of the failure is passed on.
    error_ = {position == 0 ? 0 : position - 1,
              error.id == 406 ? "number too large" : "not valid JSON"};
    return false;
  }

  Json take() { return std::move(root_); }
  [[nodiscard]] const ParseError& error() const { return error_; }

 private:
  bool refuse(const char* reason) {
    error_ = {static_cast<std::size_t>(progress_->at - begin_), reason};
    return false;
  }
  /// Reserves a long container once at its full size, because growing by doubling would move it as
  /// a whole, which takes longer than a stop may wait. For this the bytes are read twice, if there
  /// is any.
  template <class Container>
  void make_room(Container& container) {
    if (container.size() != kLong) return;
    if (!sizes_) sizes_ = long_containers(*progress_, begin_, depth_);
    if (const auto size = sizes_->find(numbers_.back()); size != sizes_->end())
      container.reserve(size->second);
  }
  // Inlined, g++ 12 takes the other members of the variant for uninitialised.
  [[gnu::noinline]] bool put(Json v) {
    if (stack_.empty()) {
      root_ = std::move(v);
    } else if (auto* array = stack_.back().as<Json::Array>()) {
      make_room(*array);
      array->push_back(std::move(v));
    } else {
      stack_.back().as<Json::Object>()->back().second = std::move(v);
    }
    return true;
  }
  bool open(Json container) {
    if (stack_.size() >= depth_) return refuse("nested too deeply");
    stack_.push_back(std::move(container));
    keys_.emplace_back();
    numbers_.push_back(opened_++);
    return true;
  }
  bool close() {
    Json done = std::move(stack_.back());
    stack_.pop_back();
    // One by one: a long object's, freed at once, would keep a stop waiting.
    for (auto& keys = keys_.back(); keys.size() > kLong; keys.erase(keys.begin()))
      if (keys.size() % 1024 == 0) ask();
    keys_.pop_back();
    numbers_.pop_back();
    return put(std::move(done));
  }

  std::size_t depth_;
  const char* begin_;
  const Progress* progress_;
  std::vector<Json> stack_;
  std::vector<std::set<std::string>> keys_;  // of each open object
  std::vector<std::size_t> numbers_;         // of the open containers, as they opened
  std::size_t opened_ = 0;
  std::optional<std::map<std::size_t, std::size_t>> sizes_;  // of the long ones, when one is met
  Json root_;
  ParseError error_;
};

std::string escaped(std::string_view name) {
  std::string out;
  for (const char c : name) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

/// Follows the parser's position to the first number that no double holds.
class NumberFinder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  [[nodiscard]] const std::optional<BadNumber>& found() const { return found_; }

  bool null() override { return next(); }
  bool boolean(bool /*unused*/) override { return next(); }
  bool number_integer(number_integer_t v) override {
    constexpr std::int64_t kExact = std::int64_t{1} << 53;
    return seen(v < -kExact || v > kExact ? kBeyond : static_cast<double>(v), std::to_string(v));
  }
  bool number_unsigned(number_unsigned_t v) override {
    constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
    return seen(v > kExact ? kBeyond : static_cast<double>(v), std::to_string(v));
  }
  bool number_float(number_float_t v, const string_t& text) override { return seen(v, text); }
  bool string(string_t& /*unused*/) override { return next(); }
  bool binary(binary_t& /*unused*/) override { return false; }
  bool start_object(std::size_t /*unused*/) override { return open(false); }
  bool key(string_t& v) override {
    tokens_.back().name = v;
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t /*unused*/) override { return open(true); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t /*unused*/, const std::string& token,
                   const nlohmann::detail::exception& error) override {
    constexpr int kOverflow = 406;
    if (error.id == kOverflow)
      note(*number_fault(std::numeric_limits<double>::infinity(), token), token);
    return false;
  }

 private:
  static constexpr double kBeyond = 0x1p54;  // beyond values that round to 2^53

  /// Of an open container, the reference token (RFC 6901) of the value that is read.
  struct ReferenceToken {
    bool array = false;
    std::size_t index = 0;
    std::string name = {};
  };

  bool next() {
    pace_.tick();
    if (!tokens_.empty()) ++tokens_.back().index;
    return true;
  }
  bool open(bool array) {
    tokens_.push_back({.array = array});
    return true;
  }
  bool close() {
    tokens_.pop_back();
    return next();
  }
  bool seen(double value, const std::string& text) {
    const auto fault = number_fault(value, text);
    if (!fault) return next();
    note(*fault, text);
    return false;
  }
  void note(const NumberFault& fault, const std::string& text) {
    std::string pointer;
    for (const auto& at : tokens_)
      pointer += "/" + (at.array ? std::to_string(at.index) : escaped(at.name));
    found_ = BadNumber{.pointer = std::move(pointer), .text = text, .fault = fault};
  }

  Pace pace_;
  std::vector<ReferenceToken> tokens_;
  std::optional<BadNumber> found_;
};

}  // namespace

void append_text(std::string& out, std::string_view text) {
  static constexpr char kHex[] = "0123456789abcdef";
  const auto escaped = [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return c == '"' || c == '\\' || u < 0x20 || u == 0x7f;
  };
  out += '"';
  for (auto at = text.begin();;) {
    const auto next = std::find_if(at, text.end(), escaped);
    out.append(at, next);
    if (next == text.end()) break;
    const auto u = static_cast<unsigned char>(*next);
    out += '\\';
    if (u < 0x20 || u == 0x7f) {
      out += "u00";
      out += kHex[u >> 4];
      out += kHex[u & 15];
    } else {
      out += *next;
    }
    at = next + 1;
  }
  out += '"';
}

char* print_number(char* to, double value) {
  value += 0.0;  // -0 is printed as 0: CBOR's integers have no other
  if (std::abs(value) < std::numeric_limits<double>::min()) value = 0.0;  // no reader takes less
  // Beyond 2^53 numbers get an exponent, because digits without one would be an integer that our
  // own reader refuses.
  constexpr double kExact = 9007199254740992.0;
  if (std::abs(value) > kExact)
    return std::to_chars(to, to + kNumberBytes, value, std::chars_format::scientific).ptr;
  // Whole numbers have all of their digits, because readers of typed integers refuse 2e+05.
  if (value == std::trunc(value))
    return std::to_chars(to, to + kNumberBytes, static_cast<std::int64_t>(value)).ptr;
  return print_shortest(to, value);
}

void append_number(std::string& out, double value) {
  char buffer[kNumberBytes];
  out.append(buffer, print_number(buffer, value));
}

const Json* Json::find(std::string_view key) const {
  const auto* object = as<Object>();
  if (object == nullptr) return nullptr;
  for (const auto& [name, member] : *object)
    if (name == key) return &member;
  return nullptr;
}

tl::expected<Json, ParseError> parse(std::string_view bytes, const ParseLimits& limits) {
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF")
    return tl::make_unexpected(ParseError{0, "byte order mark"});
  // The parser below takes a NUL for the end of its input.
  if (const auto nul = bytes.find('\0'); nul != std::string_view::npos)
    return tl::make_unexpected(ParseError{nul, "NUL byte"});
  const char* const begin = bytes.data();
  Progress progress{.at = begin, .ask_at = begin, .end = begin + bytes.size()};
  Builder builder(limits.depth, begin, &progress);
  const bool ok =
      nlohmann::json::sax_parse(CountingIterator(begin, &progress),
                                CountingIterator(begin + bytes.size(), &progress), &builder);
  if (!ok) return tl::make_unexpected(builder.error());
  return builder.take();
}

std::optional<BadNumber> find_bad_number(std::string_view json) {
  NumberFinder finder;
  nlohmann::json::sax_parse(json.begin(), json.end(), &finder);
  return finder.found();
}

}  // namespace tubecut::api
