#pragma once

#include "api/formats/drawing/canvas.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// The part of the developed outer surface that a template shows, mm.
struct TemplateField {
  double x_from = 0.0, x_to = 0.0, z_from = 0.0, z_datum = 0.0;
  double tab = 0.0;     // beyond x_to, to glue to the other border
  double radius = 0.0;  // outer, of the tube
  bool mirrored = false;

  [[nodiscard]] double width() const { return x_to - x_from + tab; }
  [[nodiscard]] double height() const { return z_datum - z_from; }
  /// Returns the position of a point of the surface on the drawing.
  [[nodiscard]] DrawingPoint at(double x, double z) const {
    return {mirrored ? tab + x_to - x : x - x_from, z - z_from};
  }
  /// The surface without the tab, on the drawing.
  [[nodiscard]] DrawingBox surface() const {
    const double left = mirrored ? tab : 0.0;
    return {{left, 0.0}, {left + x_to - x_from, height()}};
  }
};
/// Returns the field, with room next to the cuts for the words KEEP and SCRAP and the partners'
/// names.
[[nodiscard]] TemplateField template_field(const Development& development, const Caption& caption);

/// Room above the datum for the phi scale, mm.
inline constexpr double kScaleRoom = 9.0;

/// The lines of a template at full size, without anything else: its origin is the field's lower
/// left corner, its size the field's with the room for the scale. `cuts`: the curves that are cut.
/// template_labels.hpp labels them.
struct TemplateDrawing {
  Canvas all, cuts;
};
[[nodiscard]] TemplateDrawing draw_template(const Development& development,
                                            const TemplateField& field, const Caption& caption);

/// Returns a closed curve of a hole on the drawing, repeated one turn further if it reaches beyond
/// the seam.
[[nodiscard]] std::vector<std::vector<DrawingPoint>> copies_on(const TemplateField& field,
                                                               const CylinderCurve& curve,
                                                               bool repeated);

}  // namespace tubecut::api
