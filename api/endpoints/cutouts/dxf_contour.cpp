#include "api/endpoints/cutouts/dxf_contour.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/try.hpp"

namespace tubecut::api {
namespace {

using Eigen::Vector2d;

constexpr double kJoined = 0.01;  // mm, between the ends of two entities that are one place
constexpr double kInch = 25.4;
constexpr std::size_t kMostWays = 500;
constexpr std::string_view kReads = "LINE|ARC|CIRCLE|LWPOLYLINE|POLYLINE";

/// A pair of lines of the file.
struct Group {
  int code = 0;
  std::string_view value;
};

/// An entity with its groups; of a POLYLINE those of its vertices too.
struct Entity {
  std::string_view kind;
  std::vector<Group> groups;

  [[nodiscard]] std::optional<std::string_view> find(int code) const {
    const auto at = std::ranges::find(groups, code, &Group::code);
    return at == groups.end() ? std::nullopt : std::optional(at->value);
  }
};

/// A straight or circular way; `bulge` is the tangent of a quarter of an arc's angle, positive if
/// it turns left.
struct Way {
  Vector2d from, to;
  double bulge = 0.0;
};

tl::unexpected<Error> no_dxf(std::string hint) {
  return fail({.code = ErrorCode::bad_text, .hint = std::move(hint)});
}

/// Without the blanks around it, and without the Ctrl-Z with which DOS ends a file.
std::string_view trimmed(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r\x1a";
  const auto first = line.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(kBlank) - first + 1);
}

std::string_view next_line(std::string_view& text) {
  const auto end = text.find('\n');
  const auto line = trimmed(text.substr(0, end));
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

template <class Number>
std::optional<Number> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number out{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return out;
}

bool is_blank(std::string_view text) {
  while (!text.empty())
    if (!next_line(text).empty()) return false;
  return true;
}

/// The groups up to EOF, behind which there may be blank lines.
Result<std::vector<Group>> groups_of(std::string_view text) {
  std::vector<Group> out;
  const auto ended = [&] { return out.back().code == 0 && out.back().value == "EOF"; };
  while (!text.empty()) {
    const auto code = number_of<int>(next_line(text));
    if (!code) return no_dxf("every odd line of a DXF text is a group code, a whole number");
    out.push_back({*code, next_line(text)});
    if (ended() && is_blank(text)) break;
  }
  return out;
}

/// What of the file counts: its unit, and the entities of the section of that name.
struct Drawing {
  std::optional<std::string_view> unit;
  std::vector<Entity> entities;
};

Drawing drawing_of(const std::vector<Group>& groups) {
  Drawing out;
  std::string_view section;
  bool named = false, polyline = false;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const auto& [code, value] = groups[i];
    if (code == 0 && value == "SECTION") {
      named = true;
      continue;
    }
    if (named && code == 2) section = value;
    named = false;
    if (code == 0 && value == "ENDSEC") section = {};
    if (section == "HEADER" && code == 9 && value == "$INSUNITS" && i + 1 < groups.size())
      out.unit = groups[i + 1].value;
    if (section != "ENTITIES") continue;
    const bool part = polyline && (value == "VERTEX" || value == "SEQEND");
    if (code == 0 && !part) {
      polyline = value == "POLYLINE";
      out.entities.push_back({value, {}});
    } else if (!out.entities.empty()) {
      if (code == 0 && value == "SEQEND") polyline = false;
      out.entities.back().groups.push_back({code, value});
    }
  }
  return out;
}

Result<double> unit_of(const Drawing& drawing) {
  const auto unit = drawing.unit.value_or("0");
  if (unit == "0" || unit == "4") return 1.0;
  if (unit == "1") return kInch;
  return fail({.code = ErrorCode::bad_choice,
               .got = "$INSUNITS " + std::string(unit),
               .limit = std::string("0|1|4"),
               .unit = {},
               .hint = "save the drawing in mm (4) or inches (1)"});
}

tl::unexpected<Error> no_number(const Entity& entity, std::string_view text) {
  return no_dxf(std::string(entity.kind) + " has a coordinate that is no number: '" +
                std::string(text.substr(0, 32)) + "'");
}
tl::unexpected<Error> not_flat(const Entity& entity) {
  return fail({.code = ErrorCode::out_of_range,
               .got = std::string(entity.kind),
               .unit = {},
               .hint = "it does not lie in the plane of the drawing, x and y; flatten it"});
}

/// Reads a number of an entity; the fallback if it is absent.
Result<double> read(const Entity& entity, int code, std::optional<double> fallback = {}) {
  const auto text = entity.find(code);
  if (!text && fallback) return *fallback;
  if (!text) return no_dxf(std::string(entity.kind) + " lacks a coordinate");
  const auto value = number_of<double>(*text);
  if (!value || !std::isfinite(*value)) return no_number(entity, *text);
  return *value;
}
Result<Vector2d> read_place(const Entity& entity, int code) {
  TRY(const double x, read(entity, code));
  TRY(const double y, read(entity, code + 10));
  return Vector2d(x, y);
}

/// Returns true if an entity is seen from behind, because its extrusion points away from the
/// viewer.
Result<bool> is_from_behind(const Entity& entity) {
  constexpr double kUpright = 1e-6;
  TRY(const double x, read(entity, 210, 0.0));
  TRY(const double y, read(entity, 220, 0.0));
  TRY(const double z, read(entity, 230, 1.0));
  if (!(std::abs(x) + std::abs(y) <= kUpright * std::abs(z))) return not_flat(entity);
  return z < 0.0;
}

/// An arc turning left, from one angle to the other; a whole turn as two halves.
void add_arc(const Vector2d& centre, double radius, double from, double to, std::vector<Way>& out) {
  double sweep = std::fmod(to - from, kTwoPi);
  if (sweep <= 0.0) sweep += kTwoPi;
  const auto at = [&](double share) {
    const auto [sin, cos] = elementary::sincos(from + share * sweep);
    return Vector2d(centre + radius * Vector2d(cos, sin));
  };
  const double bulge = elementary::tan(0.125 * sweep);  // of each half
  out.push_back({at(0.0), at(0.5), bulge});
  out.push_back({at(0.5), sweep == kTwoPi ? at(0.0) : at(1.0), bulge});
}

struct Vertex {
  std::optional<double> x, y, z;
  double bulge = 0.0;
};

/// Returns the vertices of a polyline in the order of its groups.
Result<std::vector<Vertex>> vertices_of(const Entity& entity) {
  const bool light = entity.kind == "LWPOLYLINE";
  std::vector<Vertex> out;
  bool inside = light;
  for (const auto& [code, value] : entity.groups) {
    if (code == 0) inside = value == "VERTEX";
    if (!inside) continue;
    if (code == (light ? 10 : 0)) out.emplace_back();
    if (out.empty() || (code != 10 && code != 20 && code != 30 && code != 42)) continue;
    const auto number = number_of<double>(value);
    if (!number || !std::isfinite(*number)) return no_number(entity, value);
    auto& here = out.back();
    if ((code == 10 && here.x) || (code == 20 && here.y))
      return no_dxf(std::string(entity.kind) + " lacks a coordinate");
    if (code == 10) here.x = number;
    if (code == 20) here.y = number;
    if (code == 30) here.z = number;
    if (code == 42) here.bulge = *number;
  }
  return out;
}

Result<void> add_polyline(const Entity& entity, std::vector<Way>& out) {
  constexpr int kClosed = 1, kSplineOrMesh = 4 | 16 | 64;
  TRY(const double flags, read(entity, 70, 0.0));
  const auto bits = static_cast<int>(std::clamp(flags, 0.0, 255.0));
  if (entity.kind == "POLYLINE" && (bits & kSplineOrMesh) != 0)
    return fail({.code = ErrorCode::bad_choice,
                 .got = "POLYLINE of a spline or a mesh",
                 .limit = std::string(kReads),
                 .unit = {},
                 .hint = "explode it, or fit arcs to it"});
  TRY(const auto all, vertices_of(entity));
  std::vector<Way> made;
  for (const auto& vertex : all) {
    if (!vertex.x || !vertex.y) return no_dxf(std::string(entity.kind) + " lacks a coordinate");
    if (std::abs(vertex.z.value_or(0.0) - all.front().z.value_or(0.0)) > kJoined)
      return not_flat(entity);
    made.push_back({Vector2d(*vertex.x, *vertex.y), Vector2d::Zero(), vertex.bulge});
  }
  const bool closed = (bits & kClosed) != 0;
  for (std::size_t i = 0; i < made.size() && (closed || i + 1 < made.size()); ++i) {
    made[i].to = made[(i + 1) % made.size()].from;
    if ((made[i].to - made[i].from).norm() > 0.0) out.push_back(made[i]);
  }
  return {};
}

Result<void> add_line(const Entity& entity, std::vector<Way>& out) {
  TRY(const auto from, read_place(entity, 10));
  TRY(const auto to, read_place(entity, 11));
  TRY(const double low, read(entity, 30, 0.0));
  TRY(const double high, read(entity, 31, 0.0));
  if (std::abs(high - low) > kJoined) return not_flat(entity);
  out.push_back({from, to, 0.0});
  return {};
}

Result<void> add_circle(const Entity& entity, std::vector<Way>& out) {
  TRY(const auto centre, read_place(entity, 10));
  TRY(const double radius, read(entity, 40));
  double from = 0.0, to = kTwoPi;
  if (entity.kind == "ARC") {
    TRY(from, read(entity, 50));
    TRY(to, read(entity, 51));
    from *= kRadPerDeg;
    to *= kRadPerDeg;
  }
  if (!(radius > 0.0))
    return no_dxf(std::string(entity.kind) + " has a radius that is not above 0");
  add_arc(centre, radius, std::fmod(from, kTwoPi), std::fmod(to, kTwoPi), out);
  return {};
}

/// Adds an entity's ways.
Result<void> add_entity(const Entity& entity, std::vector<Way>& out) {
  using Add = Result<void> (*)(const Entity&, std::vector<Way>&);
  static constexpr std::array<std::pair<std::string_view, Add>, 5> kAdd{
      {{"LINE", add_line},
       {"ARC", add_circle},
       {"CIRCLE", add_circle},
       {"LWPOLYLINE", add_polyline},
       {"POLYLINE", add_polyline}}};
  const auto* add = std::ranges::find(kAdd, entity.kind, &std::pair<std::string_view, Add>::first);
  if (add == kAdd.end())
    return fail({.code = ErrorCode::bad_choice,
                 .got = std::string(entity.kind.substr(0, 32)),
                 .limit = std::string(kReads),
                 .unit = {},
                 .hint = "explode or remove it: the drawing has one contour and nothing else"});
  std::vector<Way> made;
  TRY(add->second(entity, made));
  if (entity.kind != "LINE") {  // a line's places are the drawing's own
    TRY(const bool behind, is_from_behind(entity));
    if (behind)
      for (auto& way : made) {
        way.from.x() = -way.from.x();
        way.to.x() = -way.to.x();
        way.bulge = -way.bulge;
      }
  }
  std::ranges::move(made, std::back_inserter(out));
  return {};
}

void turn_round(Way& way) {
  std::swap(way.from, way.to);
  way.bulge = -way.bulge;
}

/// Puts the ways one after the other, from the first on.
Result<std::vector<Way>> joined(std::vector<Way> ways) {
  for (std::size_t i = 0; i + 1 < ways.size(); ++i) {
    const Vector2d here = ways[i].to;
    double nearest = 1e300;
    std::size_t next = i + 1;
    for (std::size_t k = i + 1; k < ways.size(); ++k)
      for (const auto* end : {&ways[k].from, &ways[k].to})
        if (const double off = (*end - here).norm(); off < nearest) {
          nearest = off;
          next = k;
        }
    if (nearest > kJoined) {
      const double closes = (ways.front().from - here).norm();
      if (closes <= kJoined)
        return fail(
            {.code = ErrorCode::out_of_range,
             .hint = "the drawing has more than one contour; each is a cut-out of its own"});
      return fail({.code = ErrorCode::contour_open,
                   .got = std::min(nearest, closes),
                   .limit = kJoined,
                   .unit = "mm",
                   .hint = "nothing continues at " + brief(here.x()) + ", " + brief(here.y())});
    }
    std::swap(ways[i + 1], ways[next]);
    auto& way = ways[i + 1];
    if ((way.to - here).norm() < (way.from - here).norm()) turn_round(way);
    way.from = here;
  }
  const double gap = (ways.back().to - ways.front().from).norm();
  if (gap > kJoined)
    return fail({.code = ErrorCode::contour_open,
                 .got = gap,
                 .limit = kJoined,
                 .unit = "mm",
                 .hint = "nothing continues at " + brief(ways.back().to.x()) + ", " +
                         brief(ways.back().to.y())});
  ways.back().to = ways.front().from;
  return ways;
}

/// A way as a piece of a contour; its arc passes through both ends, which may have been moved.
cutout::DrawnSegment piece_of(const Way& way) {
  cutout::DrawnSegment out{.to = way.to};
  if (way.bulge == 0.0) return out;
  const Vector2d half = 0.5 * (way.to - way.from), left(-half.y(), half.x());
  const double b = way.bulge;
  out.centre = way.from + half + left * ((1.0 - b * b) / (2.0 * b));
  out.clockwise = b < 0.0;
  return out;
}

}  // namespace

Result<cutout::Contour> read_dxf_contour(std::string_view text) {
  if (constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF"; text.starts_with(kByteOrderMark))
    text.remove_prefix(kByteOrderMark.size());
  TRY(const auto groups, groups_of(text));
  const auto drawing = drawing_of(groups);
  TRY(const auto unit, unit_of(drawing));
  std::vector<Way> ways;
  for (const auto& entity : drawing.entities)
    if (entity.find(67).value_or("0") != "1")  // what lies on the paper is not the drawing
      TRY(add_entity(entity, ways));
  if (ways.empty()) return no_dxf("the section ENTITIES has no contour");
  if (ways.size() > kMostWays)
    return fail({.code = ErrorCode::out_of_range,
                 .got = static_cast<double>(ways.size()),
                 .limit = static_cast<double>(kMostWays),
                 .hint = "the contour has too many pieces; fit arcs to it"});
  for (auto& way : ways) {
    way.from *= unit;
    way.to *= unit;
  }
  TRY(ways, joined(std::move(ways)));
  cutout::Contour out{.start = ways.front().from, .pieces = {}, .of_file = true};
  for (const auto& way : ways) out.pieces.push_back(piece_of(way));
  return out;
}

}  // namespace tubecut::api
