#include "api/wire/reader.hpp"

#include <algorithm>
#include <cmath>

#include "api/suspicion.hpp"
#include "api/wire/shown_text.hpp"
#include "api/wire/text_encoding.hpp"

namespace tubecut::api {
namespace {

constexpr std::size_t kIssuesNamed = 32;
constexpr std::size_t kShownText = 80;
constexpr std::size_t kNamedInFull = 200;  // bytes of an unknown name, in its pointer

/// Returns the value shortened for a problem document.
Json shown(const Json& value) {
  if (value.as<Json::Array>() != nullptr || value.as<Json::Object>() != nullptr) {
    const bool object = value.as<Json::Object>() != nullptr;
    const auto size = object ? value.as<Json::Object>()->size() : value.as<Json::Array>()->size();
    return Json{std::string(object ? "an object of " : "an array of ") + std::to_string(size)};
  }
  if (const auto* s = value.as<std::string>(); s != nullptr && s->size() > kShownText) {
    auto cut = kShownText;
    while (cut > 0 && (static_cast<unsigned char>((*s)[cut]) & 0xC0) == 0x80) --cut;
    return Json{s->substr(0, cut) + "..."};
  }
  return value;
}

std::string escaped(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (c == '~')
      out += "~0";
    else if (c == '/')
      out += "~1";
    else
      out += c;
  }
  return out;
}

std::string list(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

bool below(double v, Range r) { return r.open_min ? v <= r.min : v < r.min; }
bool above(double v, Range r) { return r.open_max ? v >= r.max : v > r.max; }

}  // namespace

Reader::Reader(const Json& body) : body_(&body), issues_(&own_issues_) {}

void Reader::note(std::string_view name) {
  if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.emplace_back(name);
}

void Reader::put(std::string_view name, Json value) {
  echo_.emplace_back(std::string(name), std::move(value));
}

Json Reader::take_echo(std::string_view name) {
  const auto place = std::find_if(echo_.begin(), echo_.end(),
                                  [&](const Json::Member& member) { return member.first == name; });
  if (place == echo_.end()) return Json{};
  Json out = std::move(place->second);
  echo_.erase(place);
  return out;
}

bool Reader::understood(std::string_view name) const {
  return std::any_of(echo_.begin(), echo_.end(),
                     [&](const Json::Member& member) { return member.first == name; });
}

bool Reader::sound(std::string_view name) const {
  const auto at = pointer_ + "/" + std::string(name);
  return std::ranges::none_of(*issues_, [&](const FieldIssue& issue) {
    return issue.pointer == at || issue.pointer.starts_with(at + "/");
  });
}

void Reader::issue(FieldIssue issue, const Json* value) {
  issue.pointer = issue.pointer.empty() ? pointer_ : pointer_ + "/" + issue.pointer;
  record(std::move(issue), value);
}

void Reader::record(FieldIssue issue, const Json* value) {
  if (silent_ || issues_->size() >= kIssuesNamed) return;
  // One issue per field is enough, because others would follow from it.
  for (const auto& known : *issues_)
    if (known.pointer == issue.pointer) return;
  if (value != nullptr) issue.got = shown(*value);
  issues_->push_back(std::move(issue));
}

void Reader::adopt(std::string_view name, Reader& child) {
  child.finish();
  put(name, Json{std::move(child.echo_)});
}

void Reader::finish() {
  const auto* object = body_->as<Json::Object>();
  if (object == nullptr || silent_) return;
  std::vector<std::string> open;  // known here, and not given
  for (const auto& name : known_)
    if (!has(name)) open.push_back(name);
  for (const auto& [name, value] : *object) {
    pace_.tick();
    if (issues_->size() >= kIssuesNamed) return;
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    auto hint = "known here: " + list(known_);
    if (const auto near = nearest_field(name, open); !near.empty())
      hint = "did you mean " + near + "?";
    else if (const auto twin = slip_of(name, known_); !twin.empty())
      hint = twin + " is given already; remove one of the two";
    if (name.size() > kNamedInFull) {
      const Json cut(name);
      record({.code = ErrorCode::unknown_field,
              .pointer = pointer_,
              .hint = "a field whose name has " + std::to_string(name.size()) + " bytes; " + hint},
             &cut);
      continue;
    }
    record({.code = ErrorCode::unknown_field,
            .pointer = pointer_ + "/" + escaped(name),  // the empty name too is a name
            .hint = std::move(hint)},
           &value);
  }
}

std::vector<FieldIssue> Reader::finish_root() {
  if (body_->as<Json::Object>() == nullptr)
    issue({.code = ErrorCode::wrong_type, .hint = "the body must be one JSON object"}, body_);
  finish();
  return std::move(own_issues_);
}

/// `wanted`: the type of the field, in a word.
const Json* Reader::required(std::string_view name, std::string_view wanted) {
  note(name);
  const auto* field = find(name);
  if (field == nullptr && body_->as<Json::Object>() != nullptr)
    issue({.code = ErrorCode::missing_field,
           .pointer = std::string(name),
           .unit = std::string(unit_of(name)),
           .hint = std::string(wanted) + " is required"});
  return field;
}

const Json* Reader::required_container(std::string_view name, bool object) {
  const auto wanted = object ? "an object" : "an array";
  const auto* field = required(name, wanted);
  if (field == nullptr) return nullptr;
  const bool right =
      object ? field->as<Json::Object>() != nullptr : field->as<Json::Array>() != nullptr;
  if (right) return field;
  issue({.code = ErrorCode::wrong_type,
         .pointer = std::string(name),
         .hint = std::string(wanted) + " is required"},
        field);
  return nullptr;
}

const Json::Array* Reader::required_array(std::string_view name, CountRange count) {
  const auto* field = required_container(name, false);
  if (field == nullptr) return nullptr;
  const auto* items = field->as<Json::Array>();
  const auto n = items->size();
  if (n >= count.min && n <= count.max) return items;
  const bool few = n < count.min;
  FieldIssue bad{.code = ErrorCode::wrong_count, .pointer = std::string(name)};
  bad.got = Json{static_cast<double>(n)};
  bad.limit = Json{static_cast<double>(few ? count.min : count.max)};
  bad.hint =
      (few ? "at least " : "at most ") + std::to_string(few ? count.min : count.max) + " elements";
  if (!few && !count.instead.empty()) bad.hint += "; " + std::string(count.instead);
  issue(std::move(bad));
  return nullptr;
}

std::optional<double> Reader::checked(std::string_view name, const Json& value, Range range,
                                      const std::string& step) {
  const auto* d = value.as<double>();
  const auto unit = std::string(unit_of(name));
  if (d == nullptr) {
    issue({.code = ErrorCode::not_a_number,
           .pointer = step,
           .unit = unit,
           .hint = "a JSON number is required"},
          &value);
    return std::nullopt;
  }
  if (!below(*d, range) && !above(*d, range)) return *d;
  const bool low = below(*d, range);
  FieldIssue bad{.code = ErrorCode::out_of_range, .pointer = step, .unit = unit};
  bad.limit = Json{low ? range.min : range.max};
  bad.hint = low ? (range.open_min ? "must be greater than " : "must be at least ")
                 : (range.open_max ? "must be less than " : "must be at most ");
  bad.hint += tubecut::shown(low ? range.min : range.max) + (unit.empty() ? "" : " " + unit);
  bad.hint += other_unit_hint(*d, unit, range.min, range.max);
  issue(std::move(bad), &value);
  return std::nullopt;
}

double Reader::number(std::string_view name, Range range, std::optional<double> fallback) {
  note(name);
  if (!has(name) && fallback) {
    put(name, Json{*fallback});
    return *fallback;
  }
  const auto* field = required(name, "a number");
  const auto value =
      field == nullptr ? std::nullopt : checked(name, *field, range, std::string(name));
  if (!value) return fallback.value_or(1.0);
  put(name, Json{*value});
  return *value;
}

std::optional<double> Reader::optional_number(std::string_view name, Range range) {
  note(name);
  if (!has(name)) return std::nullopt;
  return number(name, range);
}

int Reader::integer(std::string_view name, int min, int max, std::optional<int> fallback) {
  const auto value =
      number(name, {.min = static_cast<double>(min), .max = static_cast<double>(max)},
             fallback ? std::optional<double>(static_cast<double>(*fallback)) : std::nullopt);
  if (value != std::floor(value)) {
    issue({.code = ErrorCode::not_an_integer,
           .pointer = std::string(name),
           .hint = "a whole number is required"},
          find(name));
    return fallback.value_or(min);
  }
  return static_cast<int>(std::clamp(value, static_cast<double>(min), static_cast<double>(max)));
}

bool Reader::flag(std::string_view name, std::optional<bool> fallback) {
  note(name);
  if (!has(name) && fallback) {
    put(name, Json{*fallback});
    return *fallback;
  }
  const auto* field = required(name, "true or false");
  if (field == nullptr) return false;
  const auto* value = field->as<bool>();
  if (value == nullptr) {
    issue({.code = ErrorCode::wrong_type,
           .pointer = std::string(name),
           .hint = "true or false is required"},
          field);
    return false;
  }
  put(name, Json{*value});
  return *value;
}

std::string Reader::text(std::string_view name, std::size_t longest) {
  const auto* field = required(name, "a text");
  if (field == nullptr) return {};
  const auto* value = field->as<std::string>();
  if (value == nullptr) {
    issue(
        {.code = ErrorCode::wrong_type, .pointer = std::string(name), .hint = "a text is required"},
        field);
    return {};
  }
  if (!is_visible(*value, longest) || !shows_something(*value)) {
    FieldIssue bad{.code = ErrorCode::bad_text, .pointer = std::string(name)};
    bad.limit = Json{static_cast<double>(longest)};
    bad.hint = value->empty() || shows_something(*value)
                   ? "1 to that many visible characters"
                   : "it consists only of blanks or invisible characters";
    issue(std::move(bad), field);
    return {};
  }
  put(name, Json{*value});
  return *value;
}

std::string Reader::ascii_text(std::string_view name, std::size_t longest) {
  auto out = text(name, longest);
  if (in_ascii(out) != out) {
    issue({.code = ErrorCode::bad_text,
           .pointer = std::string(name),
           .got = Json{out},
           .hint = "only printable ASCII characters, because it becomes a word of a program"});
    return {};
  }
  return out;
}

std::optional<std::string> Reader::optional_text(std::string_view name, std::size_t longest) {
  note(name);
  if (!has(name)) return std::nullopt;
  return text(name, longest);
}

Angle Reader::angle(std::string_view name, Range range, std::optional<Angle> fallback) {
  const bool degrees = name.ends_with("_deg");
  const auto wire = [&](Angle a) { return degrees ? a.deg() : a.rad(); };
  const auto value =
      number(name, range, fallback ? std::optional<double>(wire(*fallback)) : std::nullopt);
  return degrees ? Angle::deg(value) : Angle::rad(value);
}

std::optional<Angle> Reader::optional_angle(std::string_view name, Range range) {
  note(name);
  if (!has(name)) return std::nullopt;
  return angle(name, range);
}

Angle Reader::angle_either(std::string_view stem, Range range) {
  const auto degrees = std::string(stem) + "_deg";
  const auto radians = std::string(stem) + "_rad";
  const auto which = exactly_one({degrees, radians});
  if (!which) return Angle::rad(1.0);
  if (*which == 1) return angle(radians, range);
  range.min *= kDegPerRad;
  range.max *= kDegPerRad;
  return angle(degrees, range);
}

std::vector<double> Reader::column(std::string_view name, CountRange count, Range range) {
  std::vector<double> out;
  const auto* items = required_array(name, count);
  if (items == nullptr) return out;
  out.reserve(items->size());
  Json::Array echo;
  echo.reserve(items->size());
  for (std::size_t i = 0; i < items->size(); ++i) {
    pace_.tick();
    echo.push_back((*items)[i]);
    const auto value =
        checked(name, (*items)[i], range, std::string(name) + "/" + std::to_string(i));
    out.push_back(value.value_or(0.0));
  }
  put(name, Json{std::move(echo)});
  return out;
}

std::vector<double> Reader::angle_column(std::string_view name, CountRange count, Range range) {
  auto out = column(name, count, range);
  if (name.ends_with("_deg"))
    for (auto& v : out) v = Angle::deg(v).rad();
  return out;
}

std::vector<bool> Reader::flag_column(std::string_view name, CountRange count) {
  std::vector<bool> out;
  const auto* items = required_array(name, count);
  if (items == nullptr) return out;
  Json::Array echo;
  echo.reserve(items->size());
  for (std::size_t i = 0; i < items->size(); ++i) {
    pace_.tick();
    echo.push_back((*items)[i]);
    const auto* value = (*items)[i].as<bool>();
    if (value == nullptr)
      issue({.code = ErrorCode::wrong_type,
             .pointer = std::string(name) + "/" + std::to_string(i),
             .hint = "true or false is required"},
            &(*items)[i]);
    out.push_back(value != nullptr && *value);
  }
  put(name, Json{std::move(echo)});
  return out;
}

std::vector<std::string> Reader::text_column(std::string_view name, CountRange count,
                                             std::size_t longest) {
  std::vector<std::string> out;
  const auto* items = required_array(name, count);
  if (items == nullptr) return out;
  Json::Array echo;
  echo.reserve(items->size());
  for (std::size_t i = 0; i < items->size(); ++i) {
    pace_.tick();
    echo.push_back((*items)[i]);
    const auto* value = (*items)[i].as<std::string>();
    const bool text = value != nullptr && is_visible(*value, longest);
    if (!text)
      issue({.code = value == nullptr ? ErrorCode::wrong_type : ErrorCode::bad_text,
             .pointer = std::string(name) + "/" + std::to_string(i),
             .hint = "a text of visible characters is required"},
            &(*items)[i]);
    out.push_back(text ? *value : std::string{});
  }
  put(name, Json{std::move(echo)});
  return out;
}

Eigen::Vector3d Reader::vector3(std::string_view name, Range range) {
  const auto values = column(name, {.min = 3, .max = 3}, range);
  return values.size() == 3 ? Eigen::Vector3d(values[0], values[1], values[2])
                            : Eigen::Vector3d::UnitZ();
}

std::vector<std::pair<double, double>> Reader::pairs(std::string_view name, CountRange count,
                                                     Range first, Range second) {
  std::vector<std::pair<double, double>> out;
  const auto* items = required_array(name, count);
  if (items == nullptr) return out;
  Json::Array echo;
  echo.reserve(items->size());
  for (std::size_t i = 0; i < items->size(); ++i) {
    pace_.tick();
    echo.push_back((*items)[i]);
    const auto step = std::string(name) + "/" + std::to_string(i);
    const auto* pair = (*items)[i].as<Json::Array>();
    if (pair == nullptr || pair->size() != 2) {
      issue({.code = pair == nullptr ? ErrorCode::wrong_type : ErrorCode::wrong_count,
             .pointer = step,
             .limit = Json{2.0},
             .hint = "a pair of numbers is required"},
            &(*items)[i]);
      continue;
    }
    const auto a = checked(name, (*pair)[0], first, step + "/0");
    const auto b = checked(name, (*pair)[1], second, step + "/1");
    out.emplace_back(a.value_or(0.0), b.value_or(0.0));
  }
  put(name, Json{std::move(echo)});
  return out;
}

bool Reader::is_null(std::string_view name) {
  note(name);
  if (!is<std::nullptr_t>(name)) return false;
  put(name, Json{});
  return true;
}

std::optional<double> Reader::nullable_number(std::string_view name, Range range) {
  return is_null(name) ? std::nullopt : optional_number(name, range);
}

std::optional<std::size_t> Reader::choose(std::string_view name,
                                          std::span<const std::string_view> names,
                                          std::optional<std::size_t> fallback) {
  note(name);
  if (!has(name) && fallback) {
    put(name, Json{std::string(names[*fallback])});
    return fallback;
  }
  auto list = one_of(names);
  const auto* field = required(name, "one of " + list);
  if (field == nullptr) return std::nullopt;
  const auto* value = field->as<std::string>();
  for (std::size_t i = 0; value != nullptr && i < names.size(); ++i) {
    if (*value != names[i]) continue;
    put(name, *field);
    return i;
  }
  FieldIssue bad{.code = value == nullptr ? ErrorCode::wrong_type : ErrorCode::bad_choice,
                 .pointer = std::string(name)};
  bad.hint = "one of " + list;
  bad.limit = Json{std::move(list)};
  issue(std::move(bad), field);
  return std::nullopt;
}

std::optional<std::size_t> Reader::exactly_one(std::initializer_list<std::string_view> names) {
  std::optional<std::size_t> found;
  std::string list;
  std::size_t index = 0, given = 0;
  for (const auto name : names) {
    note(name);
    list += (list.empty() ? "" : " or ") + std::string(name);
    given += has(name) ? 1 : 0;
    if (has(name)) found = index;
    ++index;
  }
  if (given == 1) return found;
  if (body_->as<Json::Object>() == nullptr) return std::nullopt;
  for (const auto name : names)
    if (given == 0 || has(name))
      issue({.code = given == 0 ? ErrorCode::missing_field : ErrorCode::exclusive_fields,
             .pointer = std::string(name),
             .hint = "give exactly one of " + list},
            find(name));
  return std::nullopt;
}

}  // namespace tubecut::api
