#pragma once

#include <string>

#include "api/wire/format.hpp"
#include "core/cutoff/feed_curve.hpp"

namespace tubecut::api {

/// The lookup table; with ?view=samples the servo set points of the whole cycle.
[[nodiscard]] std::string feed_curve_csv(const cutoff::FeedCurveSpec& spec,
                                         const cutoff::FeedCurve& curve, const Caption& caption);

/// The source's four pictures: stroke over feed, cylinder speed, fit over speed, displacement over
/// the cycle.
[[nodiscard]] std::string feed_curve_svg(const cutoff::FeedCurveSpec& spec,
                                         const cutoff::FeedCurve& curve, const Caption& caption);

/// An IEC 61131-3 function block: the rounded polynomial in Horner form, its time window, and
/// `valid`, false outside it.
[[nodiscard]] std::string feed_curve_structured_text(const cutoff::FeedCurveSpec& spec,
                                                     const cutoff::FeedCurve& curve,
                                                     const Caption& caption);

}  // namespace tubecut::api
