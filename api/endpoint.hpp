#pragma once

#include <span>
#include <string_view>

#include "api/run.hpp"
#include "api/wire/check_limit.hpp"
#include "api/wire/format.hpp"
#include "api/wire/reader.hpp"

namespace tubecut::api {

struct Endpoint {
  std::string_view id;
  std::string_view path;
  std::size_t max_body = 0;
  double budget_s = 0.0;  // of CPU, unless configured
  Reply (*handle)(Reader& in, Run& run) = nullptr;
  /// The first part of the same: an answer without the results that its lines, which are requests,
  /// produce.
  Reply (*begin)(Reader& in, Run& run) = nullptr;
  std::span<const FormatName> formats;
  std::span<const std::string_view> accepts;  // names allowed in `accept`
  std::span<const CheckLimit> checks;
};

/// Every endpoint, in the order of the contract.
[[nodiscard]] std::span<const Endpoint> endpoints();

}  // namespace tubecut::api
