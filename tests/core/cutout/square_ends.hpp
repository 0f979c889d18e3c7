#pragma once

#include "core/bevel/table/table.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::testing {

/// Makes both ends of a part square and without a weld, so that z counts from the start.
template <class PartSpec>
void make_ends_square(PartSpec& part) {
  for (auto* end : {&part.start, &part.finish}) {
    end->cut.partners = {joint::PlaneCutter{{0, 0, 0}, {0, 0, 1}}};
    end->cut.groove = bevel::SquareCut{};
    end->cut.contact = bevel::Contact::automatic;
    end->cut.smoothing = bevel::NoSmoothing{};
    end->cut.sampling.tolerance = joint::Tolerance{.value = 0.05};
    end->welded = false;
  }
}

}  // namespace tubecut::testing
