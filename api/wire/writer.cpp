#include "api/wire/writer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/angle.hpp"

namespace tubecut::api {

namespace {

/// Returns the values if all are 32-bit integers.
std::optional<std::vector<std::int32_t>> counts_of(const Json::Array& values) {
  std::vector<std::int32_t> out;
  out.reserve(values.size());
  Pace pace;
  for (const auto& value : values) {
    pace.tick();
    const auto* number = value.as<double>();
    if (number == nullptr || *number != std::trunc(*number) ||
        !(*number >= -2147483648.0 && *number <= 2147483647.0))
      return std::nullopt;
    out.push_back(static_cast<std::int32_t>(*number));
  }
  return out;
}

}  // namespace

Writer::Writer(std::size_t reserve, Encoding encoding) {
  if (encoding == Encoding::cbor)
    cbor_.emplace();
  else
    out_.reserve(reserve);
}

Writer Writer::hashing() {
  Writer out(2 * kHashed);
  out.hash_.emplace();
  return out;
}

Writer Writer::part() const { return Writer(0, cbor_ ? Encoding::cbor : Encoding::json); }

void Writer::hash_so_far() {
  hash_->add(out_);
  out_.clear();
}

std::string Writer::sha256() {
  if (!hash_) return api::sha256(out_);
  hash_so_far();
  return hash_->hex();
}

void Writer::leave_out(Cut cut) {
  if (hash_) return;
  cut.to = out_.size();
  if (!cuts_.empty() && cuts_.back().to == cut.from)
    cuts_.back().to = cut.to;
  else
    cuts_.push_back(cut);
}

void Writer::put(Writer part) {
  if (cbor_) return cbor_->raw(part.take());
  for (auto cut : part.cuts_) {
    cut.from += out_.size();
    cut.to += out_.size();
    if (!hash_) cuts_.push_back(cut);
  }
  out_ += part.out_;
  fresh_ = false;
}

std::string Writer::take() {
  if (cbor_) return cbor_->take();
  if (cuts_.empty()) return std::move(out_);
  std::string seen;
  std::size_t at = 0;
  for (const auto& cut : cuts_) {
    seen += std::string_view(out_).substr(at, cut.from - at);
    at = cut.to;
    if (cut.first && out_[at] == ',') ++at;
  }
  seen += std::string_view(out_).substr(at);
  return seen;
}

void Writer::key(std::string_view name) {
  separate();
  if (cbor_) return cbor_->key(name);
  append_text(out_, name);
  out_ += ':';
  fresh_ = true;
}

void Writer::open(char c) {
  if (cbor_)
    cbor_->open(c == '{');
  else
    out_ += c;
  fresh_ = true;
}

void Writer::close(char c) {
  if (cbor_)
    cbor_->close();
  else
    out_ += c;
  fresh_ = false;
}

void Writer::number(double value, std::string_view name) {
  if (!std::isfinite(value)) throw NotFinite("not finite: " + std::string(name));
  if (cbor_) return cbor_->number(value);
  append_number(out_, value);
  fresh_ = false;
}

void Writer::integer(std::int64_t value) {
  if (cbor_) return cbor_->integer(value);
  char buffer[24];
  out_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  fresh_ = false;
}

void Writer::boolean(bool value) {
  if (cbor_) return cbor_->boolean(value);
  out_ += value ? "true" : "false";
  fresh_ = false;
}

void Writer::null() {
  if (cbor_) return cbor_->null();
  out_ += "null";
  fresh_ = false;
}

void Writer::value(double number) { this->number(number, "element"); }

void Writer::value(std::string_view text) {
  if (cbor_) return cbor_->text(text);
  append_text(out_, text);
  fresh_ = false;
}

void Writer::json(const Json& of) {
  if (const auto* b = of.as<bool>()) {
    boolean(*b);
  } else if (const auto* d = of.as<double>()) {
    value(*d);
  } else if (const auto* s = of.as<std::string>()) {
    value(std::string_view(*s));
  } else if (const auto* a = of.as<Json::Array>()) {
    if (cbor_ && cbor_->in_counts())
      if (const auto counts = counts_of(*a)) return cbor_->typed_array(*counts);
    list(*a, [this](const Json& item) { json(item); });
  } else if (const auto* o = of.as<Json::Object>()) {
    object([o](Writer& w) {
      for (const auto& [name, member] : *o) w.field(name, member);
    });
  } else {
    null();
  }
}

void Writer::field(std::string_view name, double value) {
  key(name);
  number(value, name);
}

void Writer::field(std::string_view name, const Json& value) {
  key(name);
  json(value);
}

void Writer::degrees(std::string_view name, double radians) { field(name, radians * kDegPerRad); }

/// Writes one after the other into the buffer, which has room for the longest, so a column costs
/// only its numbers.
template <class Values, class F>
void Writer::straight(const Values& values, F print) {
  constexpr std::size_t kAtOnce = 256;
  out_ += '[';
  for (std::size_t i = 0; i < values.size();) {
    ask();
    if (out_.size() >= kHashed && hash_) hash_so_far();
    const std::size_t end = std::min(values.size(), i + kAtOnce);
    const std::size_t before = out_.size(), most = (end - i) * (kNumberBytes + 1);
    out_.resize(before + most);
    char* to = out_.data() + before;
    for (; i < end; ++i) {
      to = print(to, values[i]);
      *to++ = ',';
    }
    out_.resize(static_cast<std::size_t>(to - out_.data()));
  }
  if (values.size() == 0) out_ += ',';
  out_.back() = ']';
  fresh_ = false;
}

void Writer::numbers(std::string_view name, std::span<const double> values, double unit) {
  key(name);
  if (cbor_) return list(values, [&](double v) { number(v * unit, name); });
  straight(values, [&](char* to, double v) {
    if (!std::isfinite(v * unit)) throw NotFinite("not finite: " + std::string(name));
    return print_number(to, v * unit);
  });
}

template <std::integral T>
void Writer::column(std::string_view name, const std::vector<T>& values) {
  key(name);
  if constexpr (std::same_as<T, std::int32_t>)
    if (cbor_ && cbor_->in_counts()) return cbor_->typed_array(values);
  if (cbor_) return list(values, [this](T v) { integer(static_cast<std::int64_t>(v)); });
  straight(values, [](char* to, T v) { return std::to_chars(to, to + kNumberBytes, v).ptr; });
}
template void Writer::column(std::string_view, const std::vector<std::int32_t>&);
template void Writer::column(std::string_view, const std::vector<std::int64_t>&);
template void Writer::column(std::string_view, const std::vector<std::size_t>&);

void Writer::column(std::string_view name, std::span<const double> values) {
  numbers(name, values, 1.0);
}

void Writer::degrees_column(std::string_view name, std::span<const double> radians) {
  numbers(name, radians, kDegPerRad);
}

void Writer::column(std::string_view name, const std::vector<std::string>& values) {
  key(name);
  list(values, [this](const std::string& v) { value(std::string_view(v)); });
}

void Writer::flags(std::string_view name, const std::vector<bool>& values) {
  key(name);
  if (cbor_) return list(values, [this](bool v) { boolean(v); });
  straight(values, [](char* to, bool v) {
    const std::string_view word = v ? "true" : "false";
    return to + word.copy(to, word.size());
  });
}

void Writer::raw(std::string_view name, std::string_view encoded) {
  key(name);
  if (cbor_) return cbor_->raw(encoded);
  out_ += encoded;
  fresh_ = false;
}

std::string dump(const Json& json) {
  Writer out(256);
  out.json(json);
  return out.take();
}

}  // namespace tubecut::api
