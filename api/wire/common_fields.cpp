#include "api/wire/common_fields.hpp"

#include <array>

#include "api/api.hpp"
#include "api/limits.hpp"

namespace tubecut::api {
namespace {

constexpr int kMaxNumerics = 1'000'000;

constexpr int kMostPieces = 99'999;  // five digits of a header line

std::vector<std::pair<std::string, std::string>> read_reference(Reader& in) {
  std::vector<std::pair<std::string, std::string>> out;
  in.optional_object("reference", [&](Reader& r) {
    for (const auto* name :
         {"part", "order", "drawing", "revision", "heat", "customer_id", "material"})
      if (auto value =
              r.optional_text(name, static_cast<std::size_t>(limit::reference_characters_max)))
        out.emplace_back(name, *value);
    r.note("quantity");
    if (r.has("quantity"))
      out.emplace_back("quantity", std::to_string(r.integer("quantity", 1, kMostPieces)));
    return 0;
  });
  return out;
}

bool read_log(Reader& in) {
  static constexpr std::array kLog{Option<bool>{"inline", true}};
  in.note("log");
  return in.has("log") && in.choice("log", kLog);
}

}  // namespace

CommonFields read_common_fields(Reader& in, std::span<const std::string_view> accepts) {
  CommonFields out;
  out.reference = read_reference(in);
  out.reference_echo = in.take_echo("reference");
  out.inline_log = read_log(in);
  in.take_echo("log");
  in.note("numerics");
  if (in.has("numerics")) out.numerics = in.integer("numerics", 1, kMaxNumerics);
  if (accepts.empty()) return out;  // `accept` is as unknown there as any other name
  in.optional_object("accept", [&](Reader& r) {
    for (const auto name : accepts)
      if (const auto value = r.optional_number(name, kNotNegative))
        out.accept.push_back({name, *value});
    return 0;
  });
  return out;
}

void read_inner_common_fields(Reader& in) {
  read_reference(in);
  read_log(in);
  in.note("numerics");
  if (in.has("numerics"))
    if (const int pinned = in.integer("numerics", 1, kMaxNumerics); pinned != numerics())
      in.issue({.code = ErrorCode::numerics_mismatch,
                .pointer = "numerics",
                .limit = Json{static_cast<double>(numerics())}},
               in.find("numerics"));
  in.note("accept");
  if (in.has("accept"))
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "accept",
              .hint = "applies only if this request is sent by itself; omit it here"},
             in.find("accept"));
}

}  // namespace tubecut::api
