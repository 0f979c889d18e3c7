#include "api/wire/file_name.hpp"

#include <algorithm>

#include "api/catalog/posts.hpp"
#include "api/wire/text_encoding.hpp"

namespace tubecut::api {
namespace {

using Reference = std::vector<std::pair<std::string, std::string>>;

constexpr std::size_t kLongestValue = 60;
constexpr std::size_t kLongestName = 200;   // bytes; file systems take 255
constexpr std::size_t kLongestEnding = 16;  // kept of a name that is cut short
constexpr std::string_view kUnsaid = "none";
/// Names that are devices on some systems, with any extension; the second list also with a digit.
constexpr std::string_view kDevices[] = {"CON", "PRN", "AUX", "NUL"}, kNumbered[] = {"COM", "LPT"};

std::string upper(std::string_view text) {
  std::string out(text);
  for (auto& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

bool is_device(std::string_view name) {
  const auto stem = upper(name.substr(0, name.find('.')));
  const bool numbered = stem.size() == 4 && stem[3] >= '0' && stem[3] <= '9';
  return std::ranges::find(kDevices, stem) != std::end(kDevices) ||
         (numbered &&
          std::ranges::find(kNumbered, std::string_view(stem).substr(0, 3)) != std::end(kNumbered));
}

std::string of_reference(const Reference& reference, std::string_view name) {
  for (const auto& [key, text] : reference)
    if (key == name) return text;
  return {};
}

/// Returns all fields that identify the piece.
std::string whole(const Reference& reference) {
  std::string out;
  for (const auto* name : {"order", "drawing", "part", "revision"})
    if (const auto text = of_reference(reference, name); !text.empty())
      out += (out.empty() ? "" : "_") + text;
  return out;
}

std::string_view what_is_cut(std::string_view endpoint) {
  if (endpoint == "parts") return "part";
  return endpoint == "bevel-tables" ? "cut" : "schedule";
}

std::string shortened(std::string name) {
  if (name.size() <= kLongestName) return name;
  const auto dot = name.rfind('.');
  const auto ending = dot != std::string::npos && name.size() - dot <= kLongestEnding
                          ? name.substr(dot)
                          : std::string();
  return name.substr(0, kLongestName - ending.size()) + ending;
}

/// A name that no system takes for a path, an option, a hidden file or a device.
std::string sound(std::string name) {
  name = shortened(std::move(name));
  if (name.starts_with('.') || name.starts_with('-')) name.front() = '_';
  if (name.ends_with('.')) name.back() = '_';
  return is_device(name) ? "_" + name : name;
}

std::string file_name(const std::string& line, std::string_view endpoint,
                      const Reference& reference, std::string_view input_sha256) {
  const auto safe = [](const std::string& text) {
    return text.empty() ? std::string(kUnsaid) : in_file_name(text).substr(0, kLongestValue);
  };
  auto out = post_line(line, {{"part", safe(of_reference(reference, "part"))},
                              {"revision", safe(of_reference(reference, "revision"))},
                              {"order", safe(of_reference(reference, "order"))},
                              {"drawing", safe(of_reference(reference, "drawing"))},
                              {"reference", safe(whole(reference))},
                              {"cut", std::string(what_is_cut(endpoint))},
                              {"input", std::string(input_sha256.substr(0, 8))}});
  out.pop_back();  // the end of the line
  return sound(std::move(out));
}

}  // namespace

std::string in_file_name(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    auto rest = text;
    (void)take_character(rest);
    const auto one = in_ascii(text.substr(0, text.size() - rest.size())).value_or("_");
    text = rest;
    for (const char c : one) {
      const bool kept = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                        (c >= 'a' && c <= 'z') || c == '.' || c == '_' || c == '-';
      out += kept ? c : '_';
    }
  }
  return out;
}

ProgramFile program_file(const FormatName& format, const FormatOptions& options,
                         std::string_view endpoint, const Reference& reference,
                         std::string_view input_sha256) {
  ProgramFile out{.media = std::string(format.media), .ending = ".ngc", .name = {}};
  const bool by_post = std::ranges::find(format.options, "post") != format.options.end();
  if (!by_post || format.is_bundle()) return out;
  const auto& post = post_of(options);
  if (post.is_point_pairs()) {
    out.media = kPointPairsMedia;
    out.ending = ".json";
  }
  if (post.file_name) out.name = file_name(*post.file_name, endpoint, reference, input_sha256);
  return out;
}

}  // namespace tubecut::api
