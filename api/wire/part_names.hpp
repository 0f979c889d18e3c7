#pragma once

#include "core/base/names.hpp"
#include "core/part/member.hpp"
#include "core/part/webs.hpp"

/// Wire names of the enumerations of parts.
namespace tubecut {

template <>
inline constexpr auto kNames<part::Datum> =
    std::to_array<Option<part::Datum>>({{"up", part::Datum::up},
                                        {"seam", part::Datum::seam},
                                        {"first_cutter", part::Datum::first_cutter}});
template <>
inline constexpr auto kNames<part::Mark::Kind> =
    std::to_array<Option<part::Mark::Kind>>({{"datum_line", part::Mark::Kind::datum_line},
                                             {"part_mark", part::Mark::Kind::part_mark},
                                             {"partner", part::Mark::Kind::partner},
                                             {"text", part::Mark::Kind::text}});
template <>
inline constexpr auto kNames<part::Step::What> =
    std::to_array<Option<part::Step::What>>({{"mark", part::Step::What::mark},
                                             {"hole", part::Step::What::hole},
                                             {"cutout", part::Step::What::cutout},
                                             {"finish", part::Step::What::finish},
                                             {"start", part::Step::What::start}});
template <>
inline constexpr auto kNames<part::Beside> =
    std::to_array<Option<part::Beside>>({{"hole", part::Beside::hole},
                                         {"start", part::Beside::start},
                                         {"finish", part::Beside::finish}});
template <>
inline constexpr auto kNames<part::Mistake> =
    std::to_array<Option<part::Mistake>>({{"diameter", part::Mistake::diameter},
                                          {"wall", part::Mistake::wall},
                                          {"clocking", part::Mistake::clocking},
                                          {"mirror", part::Mistake::mirror},
                                          {"b_sign", part::Mistake::b_sign},
                                          {"pivot_length", part::Mistake::pivot_length},
                                          {"height", part::Mistake::height},
                                          {"width", part::Mistake::width},
                                          {"swapped", part::Mistake::swapped},
                                          {"quarter_turn", part::Mistake::quarter_turn},
                                          {"corner", part::Mistake::corner}});
template <>
inline constexpr auto kNames<part::Tool> =
    std::to_array<Option<part::Tool>>({{"wrap", part::Tool::wrap},
                                       {"tape", part::Tool::tape},
                                       {"rule", part::Tool::rule},
                                       {"caliper", part::Tool::caliper}});

}  // namespace tubecut
