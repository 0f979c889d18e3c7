#include "core/base/error.hpp"

#include <charconv>

namespace tubecut {
namespace {

constexpr ErrorInfo kErrors[] = {
#define X(code, kind, meaning, action) {#code, ErrorKind::kind, meaning, action},
    TUBECUT_ERRORS(X)
#undef X
};

constexpr WarningInfo kWarnings[] = {
#define X(code, severity, meaning, action) {#code, Severity::severity, meaning, action},
    TUBECUT_WARNINGS(X)
#undef X
};

}  // namespace

std::string shown(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string brief(double value) {
  char text[32];
  constexpr auto kGeneral = std::chars_format::general;
  constexpr double kNoise = 1e-9;  // below the resolution of any number in a text: rounding errors
  const double read = value > -kNoise && value < kNoise ? 0.0 : value + 0.0;
  return {text, std::to_chars(text, text + sizeof text, read, kGeneral, 6).ptr};
}

const ErrorInfo& info(ErrorCode code) { return kErrors[static_cast<std::size_t>(code)]; }
const WarningInfo& info(WarningCode code) { return kWarnings[static_cast<std::size_t>(code)]; }
std::span<const ErrorInfo> all_errors() { return kErrors; }
std::span<const WarningInfo> all_warnings() { return kWarnings; }

}  // namespace tubecut
