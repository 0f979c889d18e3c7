#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/formats/drawing/order/order_sheets.hpp"
#include "core/bevel/table/angles.hpp"
#include "core/joint/sampling.hpp"

namespace tubecut::api {

// The blocks that work orders of all tubes have.

struct Fact {
  std::string name, value;
};
/// Draws facts row by row; a long value takes more columns than one.
void draw_facts(OrderSheets& sheets, const std::vector<Fact>& facts, std::size_t columns);
void rule(OrderSheets& sheets);

/// The order by the reference; an empty value is a line to write on.
[[nodiscard]] std::vector<Fact> order_facts(const Caption& caption);
[[nodiscard]] std::string name_of_part(const std::string& name, const Caption& caption);

/// Returns "Bevel B from -12° to 44°; the torch leans from -80° to 80°. ...", of all cuts' bevels.
[[nodiscard]] std::string bevel_range(const std::vector<const std::vector<double>*>& cuts,
                                      const bevel::TorchRange& torch);
void draw_verdict(OrderSheets& sheets, const std::string& bevels, const Caption& caption);

struct EndPartners {
  std::size_t count = 0;
  bool welded = true;
};
/// Draws the legend of the two cuts' colours, two lines of a sheet.
void draw_partners(OrderSheets& sheets, const EndPartners& start, const EndPartners& finish,
                   const Caption& caption);
void draw_sign_off(OrderSheets& sheets, const joint::Sampling& sampling, const Caption& caption);

/// A table's head and rows, each with a box to write in at its right end.
struct HeadColumn {
  double at;
  std::string head;
};
/// Draws the head of a table of which `with` mm stay on one sheet with it.
void draw_head(OrderSheets& sheets, const std::string& title,
               const std::vector<HeadColumn>& columns, double with);
void draw_row_line(Canvas& canvas, double y);
void draw_box(Canvas& canvas, double y, double height);

}  // namespace tubecut::api
