#include "api/formats/drawing/order/matrix_code.hpp"

#include <zint.h>

#include <memory>

namespace tubecut::api {
namespace {

using Symbol = std::unique_ptr<zint_symbol, decltype(&ZBarcode_Delete)>;

/// Returns the symbol of a text, square; without one, nothing.
Symbol encoded(std::string_view text) {
  Symbol out(ZBarcode_Create(), &ZBarcode_Delete);
  if (out == nullptr) return out;
  out->symbology = BARCODE_DATAMATRIX;
  out->input_mode = UNICODE_MODE;
  out->option_3 = DM_SQUARE;
  const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
  const int status = ZBarcode_Encode(out.get(), bytes, static_cast<int>(text.size()));
  if (status >= ZINT_ERROR) out.reset();  // a warning only says which character set it took
  return out;
}

bool is_dark(const zint_symbol& symbol, int row, int column) {
  return (symbol.encoded_data[row][column / 8] >> (column % 8) & 1) != 0;
}

}  // namespace

void draw_matrix_code(Canvas& canvas, DrawingPoint low, double side, std::string_view text) {
  constexpr double kOverlap = 0.01;  // mm: without it, viewers show white lines between rows
  constexpr Stroke kDark{.color = "none", .width = 0.0, .fill = "#000000"};
  const auto symbol = encoded(text);
  if (symbol == nullptr) return;
  const double module = side / (symbol->width + 2);
  const double left = low.x + module, top = low.y + side - module;
  for (int row = 0; row < symbol->rows; ++row)
    for (int from = 0; from < symbol->width; ++from) {
      if (!is_dark(*symbol, row, from)) continue;
      int to = from;
      while (to < symbol->width && is_dark(*symbol, row, to)) ++to;
      canvas.rectangle({left + module * from, top - module * (row + 1) - kOverlap},
                       {left + module * to, top - module * row}, kDark);
      from = to;
    }
}

}  // namespace tubecut::api
