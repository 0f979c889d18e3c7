#include "api/writer.hpp"

#include <cmath>

#include "core/base/angle.hpp"

namespace tubecut::api {

void Writer::key(std::string_view name) {
  separate();
  append_text(out_, name);
  out_ += ':';
  fresh_ = true;
}

void Writer::finite(double value, std::string_view name) {
  if (!std::isfinite(value)) throw NotFinite("not finite: " + std::string(name));
  append_number(out_, value);
}

void Writer::field(std::string_view name, double value) {
  key(name);
  finite(value, name);
  fresh_ = false;
}

void Writer::field(std::string_view name, std::string_view value) {
  key(name);
  append_text(out_, value);
  fresh_ = false;
}

void Writer::degrees(std::string_view name, double radians) { field(name, radians * kDegPerRad); }

void Writer::column(std::string_view name, std::span<const double> values) {
  list(name, values, [&](double v) { finite(v, name); });
}

void Writer::degrees_column(std::string_view name, std::span<const double> radians) {
  list(name, radians, [&](double v) { finite(v * kDegPerRad, name); });
}

void Writer::raw(std::string_view name, std::string_view json) {
  key(name);
  out_ += json;
  fresh_ = false;
}

void Writer::value(double number) {
  finite(number, "element");
  fresh_ = false;
}

void Writer::value(std::string_view text) {
  append_text(out_, text);
  fresh_ = false;
}

}  // namespace tubecut::api
