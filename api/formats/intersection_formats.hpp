#pragma once

#include <string>

#include "api/wire/format.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::api {

/// One row per point; the first column names the wall.
[[nodiscard]] std::string intersection_csv(const joint::IntersectionSpec& spec,
                                           const joint::Intersection& cut, const Caption& caption);
/// The curves over phi. The views `template` and `section`: see wrap_template.hpp, sections.hpp.
[[nodiscard]] std::string intersection_svg(const joint::IntersectionSpec& spec,
                                           const joint::Intersection& cut, const Caption& caption);
/// The views `template` and `section` again, on pages.
[[nodiscard]] std::string intersection_pdf(const joint::IntersectionSpec& spec,
                                           const joint::Intersection& cut, const Caption& caption);

/// The developed curves; view `tube`: on the tube in space.
[[nodiscard]] std::string intersection_dxf(const joint::IntersectionSpec& spec,
                                           const joint::Intersection& cut, const Caption& caption);

}  // namespace tubecut::api
