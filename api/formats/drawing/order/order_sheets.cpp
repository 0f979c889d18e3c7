#include "api/formats/drawing/order/order_sheets.hpp"

#include <utility>

#include "api/api.hpp"
#include "api/formats/drawing/order/matrix_code.hpp"

namespace tubecut::api {
namespace {

constexpr double kHead = 15.0, kBadge = 44.0, kCode = kHead;
constexpr Stroke kFrame{.width = 0.5};

struct Look {
  std::string_view said, color;
};

Look look_of(std::string_view status) {
  if (status == "ok") return {"CUTTABLE", "#1d7a46"};
  if (status == "review") return {"REVIEW FIRST", "#a65f00"};
  return {"DO NOT CUT", "#b3261e"};
}

}  // namespace

OrderSheets::OrderSheets(std::string title, std::string part, const Caption& caption)
    : title_(std::move(title)), part_(std::move(part)), caption_(caption) {
  begin();
}

void OrderSheets::begin() {
  auto& canvas = sheets_.emplace_back(kWidth, kHeight);
  const double high = kHeight - kBorder, right = kWidth - kBorder;
  canvas.rectangle({kBorder, kBorder}, {right, high}, kFrame);
  canvas.text({kBorder + kPad, high - 5.0}, title_, {.height = 2.8, .color = "#566370"});
  canvas.label({kBorder + kPad, high - 12.0}, part_, {.height = 6.0, .bold = true},
               right - kBorder - kBadge - kCode - 3.0 * kPad);
  draw_matrix_code(canvas, {right - kBadge - kCode - 1.5, high - kHead}, kCode,
                   part_ + "\n" + caption_.result_sha256);
  const auto look = look_of(caption_.verdict.status);
  canvas.rectangle({right - kBadge, high - kHead}, {right, high},
                   {.color = look.color, .width = 0.2, .fill = look.color});
  canvas.text({right - 0.5 * kBadge, high - 0.5 * kHead - 1.4}, look.said,
              {.height = 4.4, .anchor = Anchor::middle, .bold = true, .color = "#ffffff"});
  canvas.line({kBorder, high - kHead}, {right, high - kHead}, kFrame);
  y_ = high - kHead;
}

double OrderSheets::take(double height) {
  keep_together(height);
  const double top = y_;
  y_ -= height;
  return top;
}

void OrderSheets::keep_together(double height) {
  if (height > left() && y_ < kHeight - kBorder - kHead) begin();
}

std::vector<Canvas> OrderSheets::finished() {
  const double right = kWidth - kBorder;
  for (std::size_t i = 0; i < sheets_.size(); ++i) {
    auto& canvas = sheets_[i];
    canvas.line({kBorder, kLow - 1.5}, {right, kLow - 1.5}, kFrame);
    const auto job = "tubecut " + std::string(version()) + ", input " +
                     caption_.input_sha256.substr(0, 16) + ", result " +
                     caption_.result_sha256.substr(0, 16);
    canvas.text({kBorder + kPad, kBorder + 2.0}, job, {.height = 2.2, .color = "#566370"});
    canvas.text({right - kPad, kBorder + 2.0},
                "sheet " + std::to_string(i + 1) + " of " + std::to_string(sheets_.size()),
                {.height = 2.6, .anchor = Anchor::end, .bold = true});
  }
  return std::move(sheets_);
}

}  // namespace tubecut::api
