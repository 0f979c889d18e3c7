#pragma once

#include "api/format.hpp"
#include "api/formats/canvas.hpp"
#include "api/formats/development.hpp"

namespace tubecut::api {

/// The part of the developed outer surface that a template shows, mm.
struct TemplateField {
  double x_from = 0.0, x_to = 0.0, z_from = 0.0, z_datum = 0.0;
  double tab = 0.0;  // beyond x_to, to glue to the other border

  [[nodiscard]] double width() const { return x_to - x_from + tab; }
  [[nodiscard]] double height() const { return z_datum - z_from; }
};
[[nodiscard]] TemplateField template_field(const Development& development);

/// Room above the datum for the phi scale, mm.
inline constexpr double kScaleRoom = 9.0;

/// What a template shows, at full size and nothing beside it: its origin is the field's lower left
/// corner, its size the field's with the room for the scale. `cuts`: the curves that are cut.
struct TemplateDrawing {
  Canvas all, cuts;
};
[[nodiscard]] TemplateDrawing draw_template(const Development& development,
                                            const TemplateField& field, const Caption& caption);

}  // namespace tubecut::api
