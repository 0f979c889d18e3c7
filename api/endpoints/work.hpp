#pragma once

#include "api/cost.hpp"
#include "api/endpoints/motion/motion_codec.hpp"
#include "api/endpoints/part_request.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"
#include "core/cutoff/feed_curve.hpp"
#include "core/groove/groove.hpp"
#include "core/groove/mill_path.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/node/node.hpp"

namespace tubecut::api {

// What a request asks for, counted by what it says alone: the same request, the same estimate.
// bench/estimates holds it against the CPU that jobs take.

void add_work(const joint::IntersectionSpec& spec, Work& work);
void add_work(const bevel::TableSpec& spec, Work& work);
void add_work(const bevel::HoleSpec& spec, Work& work);
void add_work(const PartRequest& spec, Work& work);  // resolved
void add_work(const groove::GrooveSpec& spec, Work& work);
void add_work(const groove::MillPathSpec& spec, Work& work);
void add_work(const cutoff::FeedCurveSpec& spec, Work& work);

/// The members; the ends' profiles and tables where they are asked for. Which pairs of members come
/// near each other elsewhere than at an end is not known yet.
void add_work(const joint::NodeSpec& node, const joint::Nodes& solved,
              const joint::Sampling* profiles, const bevel::TableSpec* tables, Work& work);

/// The cut of a job, if it is computed here; and its schedule.
void add_cut_work(const ScheduleRequest& request, Work& work);
void add_schedule_work(const ScheduleRequest& request, Work& work);

}  // namespace tubecut::api
