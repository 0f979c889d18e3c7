#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/wire/reader.hpp"
#include "api/wire/writer.hpp"
#include "core/joint/target.hpp"
#include "core/section/section.hpp"

namespace tubecut::api {

/// A target that is not round.
struct SectionTarget {
  section::Section section{
      .height = 100.0, .width = 100.0, .wall = 5.0, .corner = 10.0, .inner_corner = 5.0};
  bool nominal = false;  // corners as a standard calculates with: those delivered differ
  std::optional<double> length;
};

/// Returns true if a target, or a member of a node, is a section by its kind or its size.
[[nodiscard]] bool is_section(const Json& tube);
enum class SectionKind { rectangular_tube, flat_oval_tube };
/// Reads `kind`, or its default.
[[nodiscard]] SectionKind decode_section_kind(Reader& in);
/// Reads its size, or its lengths and corners; the other fields are the caller's.
[[nodiscard]] SectionTarget decode_section(Reader& in, SectionKind kind);

/// Returns true if the request's `target` is a section.
[[nodiscard]] bool has_section_target(const Reader& in);
/// Reads `target`, a rectangular_tube or a flat_oval_tube.
[[nodiscard]] SectionTarget decode_section_target(Reader& in);
/// Returns the length, in the form that code for round targets reads.
[[nodiscard]] joint::Target target_of(const SectionTarget& section);

/// Writes the member `section` of a result: lengths and properties of the target.
void encode_section(const SectionTarget& target, Writer& w);

}  // namespace tubecut::api
