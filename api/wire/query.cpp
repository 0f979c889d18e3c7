#include "api/wire/query.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "api/catalog/posts.hpp"
#include "api/catalog/process.hpp"
#include "api/wire/motion_names.hpp"

namespace tubecut::api {
namespace {

constexpr std::array kSwitch{Option<bool>{"on", true}, Option<bool>{"off", false}};
constexpr std::array kAxial{Option<bool>{"x", false}, Option<bool>{"z", true}};
constexpr std::array kPaper{Option<Paper>{"sheet", Paper::sheet}, Option<Paper>{"a4", Paper::a4},
                            Option<Paper>{"a3", Paper::a3}, Option<Paper>{"letter", Paper::letter},
                            Option<Paper>{"tabloid", Paper::tabloid}};
constexpr std::array kPasses{Option<Passes>{"bevel", Passes::bevel},
                             Option<Passes>{"both", Passes::both}};
constexpr Range kOvercut{.min = 0.0, .max = 1'000.0};   // mm
constexpr Range kStart{.min = -360.0, .max = 360.0};    // deg
constexpr Range kOmega{.min = -360.0, .max = 360.0};    // deg
constexpr Range kPierceBevel{.min = 0.0, .max = 85.0};  // deg

constexpr std::array<std::string_view, 1> kWhole{"tabs"};
constexpr std::array<std::string_view, 3> kTexts{"machine", "material", "post"};

std::optional<int> hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

/// Decodes percent-encoding and "+"; a "%" that begins no code stays.
std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : std::nullopt;
    const auto low = high ? hex_digit(text[i + 2]) : std::nullopt;
    out += low ? static_cast<char>(*high * 16 + *low) : text[i] == '+' ? ' ' : text[i];
    if (low) i += 2;
  }
  return out;
}

/// A value of the query as the JSON value it would be in a body; a name may look like a number, as
/// the steel 1.4301.
Json typed(std::string_view name, std::string_view text) {
  if (std::ranges::find(kTexts, name) != kTexts.end()) return Json{std::string(text)};
  if (text == "true" || text == "false") return Json{text == "true"};
  double number = 0.0;
  const auto* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  if (read.ec == std::errc{} && read.ptr == end && std::isfinite(number)) return Json{number};
  return Json{std::string(text)};
}

std::string pointer(std::string_view name) { return "?" + std::string(name); }

/// The parameters as the members of one object, the first of each name.
Json::Object members(std::string_view text, std::vector<FieldIssue>& issues) {
  Json::Object out;
  while (!text.empty()) {
    const auto end = text.find('&');
    const auto item = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (item.empty()) continue;
    const auto equals = item.find('=');
    auto name = decoded(item.substr(0, equals));
    const auto value = equals == std::string_view::npos ? "" : decoded(item.substr(equals + 1));
    const bool twice = std::ranges::any_of(out, [&](const auto& one) { return one.first == name; });
    if (twice)
      issues.push_back(
          {.code = ErrorCode::repeated_parameter, .pointer = pointer(name), .got = Json{value}});
    else
      out.emplace_back(name, typed(name, value));
  }
  return out;
}

std::vector<std::string> between_commas(std::string_view text) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == ',')
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

/// Reads "nc1,step": files of a bundle, each once; the default is the first five.
std::vector<BundleFile> read_files(Reader& in) {
  constexpr std::size_t kLongest = 100;
  const auto text = in.optional_text("files", kLongest);
  std::vector<BundleFile> out;
  std::string list;
  for (const auto& file : kBundleFiles) {
    list += (list.empty() ? "" : ", ") + std::string(file.name);
    if (!text && !file.needs_speed) out.push_back(file);
  }
  if (!text) return out;
  for (const auto& name : between_commas(*text)) {
    const auto found = std::ranges::find(kBundleFiles, name, &BundleFile::name);
    const bool again = std::ranges::find(out, name, &BundleFile::name) != out.end();
    if (found != std::end(kBundleFiles) && !again)
      out.push_back(*found);
    else
      in.issue({.code = ErrorCode::bad_choice,
                .pointer = "files",
                .got = Json{name},
                .limit = Json{list},
                .hint = again ? "each once" : "names between commas, of " + list},
               nullptr);
  }
  return out;
}

/// Reads "free_end,standoff": codes separated by commas. They are checked when the answer exists.
std::vector<std::string> read_acknowledged(Reader& in, bool torch) {
  constexpr std::size_t kLongest = 1'000;
  const auto text = in.optional_text("acknowledge", kLongest);
  if (!text) return {};
  auto out = between_commas(*text);
  const auto odd = [](char c) {
    return !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9') && c != '_';
  };
  if (std::ranges::any_of(out, [&](const std::string& code) {
        return code.empty() || std::ranges::any_of(code, odd);
      }))
    in.issue({.code = ErrorCode::bad_text,
              .pointer = "acknowledge",
              .hint = "codes of warnings, between commas"},
             in.find("acknowledge"));
  if (!torch)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "acknowledge",
              .limit = Json{"torch=on"},
              .hint = "acknowledge requires torch=on"},
             in.find("acknowledge"));
  return out;
}

constexpr std::array kDialects{Option<std::string_view>{"linuxcnc", "linuxcnc"},
                               Option<std::string_view>{"qtplasmac", "qtplasmac"}};

constexpr std::size_t kLongestPost = 8'000;  // as long as a target may be

/// Reads `post`, which names one of GET /v1/posts, or is one; `dialect`, which is older, names one
/// of two. Errors within a post go to `within`.
std::shared_ptr<const Post> read_post(Reader& in, std::vector<FieldIssue>& within) {
  const auto name = in.optional_text("post", kLongestPost);
  const auto dialect = in.choice("dialect", kDialects, "linuxcnc");
  if (name && in.has("dialect"))
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "dialect",
              .hint = "post already names the post; omit dialect"},
             in.find("dialect"));
  if (name && name->starts_with('{'))
    if (auto own = inline_post(*name, "?post", within)) return own;
  if (!within.empty()) return find_post(kDialects.front().name);
  auto out = find_post(name ? *name : std::string(dialect));
  if (out == nullptr && in.understood("post"))
    in.issue({.code = ErrorCode::bad_choice,
              .pointer = "post",
              .limit = Json{post_names()},
              .hint = "one of GET /v1/posts: " + post_names()},
             in.find("post"));
  return out != nullptr ? out : find_post(kDialects.front().name);
}

/// `tabs` is how many; the others go with it.
std::optional<torch::Tabs> read_tabs(Reader& in) {
  torch::Tabs out;
  for (const auto* const name : {"tabs", "tabs_of"}) in.note(name);
  const bool any = in.has("tabs");
  if (any) out.count = in.integer("tabs", 1, torch::kMostTabs);
  if (const auto width = in.optional_number("tab_mm", kTabWidth)) out.width = *width;
  if (in.has("tabs_of")) out.of = in.choice("tabs_of", kNames<torch::Tabs::Of>);
  for (const auto* const name : {"tab_mm", "tabs_of"})
    if (!any && in.has(name) && in.understood(name))
      in.issue({.code = ErrorCode::unsupported_combination,
                .pointer = name,
                .limit = Json{"tabs"},
                .hint = "requires tabs, their number"},
               in.find(name));
  return any ? std::optional(out) : std::nullopt;
}

/// The parameters that only drawings and machine files read.
FormatOptions read_options(Reader& in, std::vector<FieldIssue>& within) {
  FormatOptions out;
  out.mirror = in.flag("mirror", false);
  out.paper = in.choice("paper", kPaper, Paper::sheet);
  out.torch = in.choice("torch", kSwitch, false);
  out.acknowledged = read_acknowledged(in, out.torch);
  out.post = read_post(in, within);
  out.process = read_machine_process(in);
  out.axial_z = in.choice("axial", kAxial, false);
  out.speed = in.optional_number("speed_mm_min", kTorchSpeed);
  out.lead = in.optional_number("lead_mm", kLeadRadius);
  out.overcut = in.optional_number("overcut_mm", kOvercut);
  out.start = in.optional_number("start_deg", kStart);
  out.pierce_bevel = in.optional_number("pierce_b_deg", kPierceBevel);
  out.pivot_length = in.optional_number("pivot_length_mm", kTorchPivotLength);
  out.pierce_height = in.optional_number("pierce_height_mm", kTipHeight);
  out.pierce_delay = in.optional_number("pierce_delay_s", kPierceDelay);
  out.cut_height = in.optional_number("cut_height_mm", kTipHeight);
  out.clearance = in.optional_number("clearance_mm", kTipClearance);
  in.note("passes");
  if (in.has("passes")) out.passes = in.choice("passes", kPasses);
  out.tabs = read_tabs(in);
  out.marks = in.choice("marks", kSwitch, false);
  out.mark_speed = in.optional_number("mark_speed_mm_min", kTorchSpeed);
  out.omega = in.optional_number("omega_deg", kOmega);
  out.files = read_files(in);
  return out;
}

/// Reports the reader's issues as issues of parameters.
void finish(Reader& in, std::vector<FieldIssue>& issues) {
  for (auto& issue : in.finish_root()) {
    // Empty: a parameter whose name is too long to be repeated.
    const auto name = issue.pointer.empty() ? std::string{} : issue.pointer.substr(1);
    const bool whole = std::ranges::find(kWhole, name) != kWhole.end();
    issue.pointer = pointer(name);
    if (issue.code == ErrorCode::not_a_number)
      issue.hint = whole ? "a whole number such as 2" : "a number such as 12.5";
    issues.push_back(std::move(issue));
  }
}

}  // namespace

ParsedQuery parse_query(std::string_view text) {
  ParsedQuery out;
  const Json body{members(text, out.issues)};
  Reader in(body);
  auto& query = out.query;
  query.validate_only = in.flag("validate_only", false);
  query.format = in.optional_text("format").value_or("");
  query.view = in.optional_text("view").value_or("");
  const auto general = in.echo().size();
  query.options = read_options(in, out.issues);
  for (auto i = general; i < in.echo().size(); ++i)
    if (const auto& name = in.echo()[i].first; in.has(name))
      query.given.emplace_back(name, *in.find(name));
  finish(in, out.issues);
  return out;
}

std::vector<FieldIssue> refuse_parameters(std::string_view text) {
  std::vector<FieldIssue> out;
  const Json body{members(text, out)};
  Reader in(body);
  finish(in, out);
  for (auto& issue : out)
    if (issue.code == ErrorCode::unknown_field) issue.hint = "this path takes no query parameters";
  return out;
}

}  // namespace tubecut::api
