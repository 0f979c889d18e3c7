#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/formats/drawing/template_drawing.hpp"

namespace tubecut::api {

/// Lowest and highest of some curves on each millimetre of a drawing's width.
class Skyline {
 public:
  explicit Skyline(double width);
  void add(const std::vector<DrawingPoint>& points, bool closed);

  struct Range {
    double low, high;  // infinite, low above high, if empty
  };
  [[nodiscard]] Range range(double from, double to) const;

 private:
  std::vector<double> low_, high_;
};

/// The words of a template: KEEP and SCRAP on their sides, the upward direction, the part, partners
/// at their segments of an edge, holes and marks by name. Their positions depend on the shown
/// window, because each is whole, clear of every other text and of the edges.
class TemplateLabels {
 public:
  TemplateLabels(const Development& development, const TemplateField& field, const Caption& caption,
                 std::string part);

  /// Draws those of the part `window` of the drawing, whose origin lies at `by` of the canvas.
  void draw(Canvas& canvas, const DrawingBox& window, DrawingPoint by) const;

 private:
  struct Hole {
    std::string label;
    LabelPlace place;
    std::vector<std::vector<DrawingPoint>> outlines;
  };
  struct Writing;
  /// The visible range of a partner's segment of an edge, x of the canvas, and the partner's name.
  struct VisibleSpan {
    double from, to;
    const std::string& name;
  };
  [[nodiscard]] std::optional<VisibleSpan> visible_span(const Writing& w,
                                                        const PartnerSpan& span) const;
  void share_name_room(Writing& w) const;
  static bool write_beside(Writing& w, const Skyline& line, bool finish, double foot, double side,
                           int k, const std::string& text, const Lettering& l);

  void write_hole(Writing& w, const Hole& hole) const;
  void write_mark(Writing& w, const part::Mark& mark) const;
  void write_partner(Writing& w, const PartnerSpan& span) const;
  void write_sides(Writing& w) const;

  const Development& d_;
  const TemplateField& field_;
  const Caption& caption_;
  std::string part_;
  Skyline start_, finish_, holes_;
  std::vector<Hole> hole_labels_;
};

}  // namespace tubecut::api
