#include "core/bevel/table/root_opens.hpp"

#include <algorithm>

namespace tubecut::bevel {

std::optional<Warning> root_opens(const TableSpec& spec, const std::vector<double>& gap,
                                  const std::function<std::string(std::size_t)>& place) {
  if (spec.contact != Contact::automatic && spec.contact != Contact::outer) return std::nullopt;
  const auto widest = std::ranges::max_element(gap);
  if (widest == gap.end() || *widest <= kOpen) return std::nullopt;
  return Warning{.code = WarningCode::root_opens,
                 .member = "contact",
                 .detail = "by up to " + brief(*widest) + " mm, at " +
                           place(static_cast<std::size_t>(widest - gap.begin())),
                 .most = *widest};
}

}  // namespace tubecut::bevel
