#pragma once

#include <string>
#include <string_view>

namespace tubecut::api {

/// A number with so many digits behind the point; never "-0.00".
[[nodiscard]] std::string fixed(double value, int digits = 2);

/// Text as XML content or attribute value.
[[nodiscard]] std::string xml_text(std::string_view text);

/// Text as the value of a DXF group: no group separator, no escape and no %% code of TEXT acts.
[[nodiscard]] std::string dxf_text(std::string_view text);

/// Text inside a comment of a machine file: letters, digits and "+-_.,:=/# "; whatever else could
/// end the comment or mean something to a control becomes '_'.
[[nodiscard]] std::string machine_text(std::string_view text);

}  // namespace tubecut::api
