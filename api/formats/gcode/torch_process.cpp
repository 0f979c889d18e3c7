#include "api/formats/gcode/torch_process.hpp"

#include <algorithm>
#include <string>

#include "api/catalog/posts.hpp"
#include "api/catalog/process.hpp"
#include "api/formats/gcode/torch_moves.hpp"
#include "api/formats/numbers.hpp"
#include "api/stop.hpp"
#include "api/wire/text_encoding.hpp"

namespace tubecut::api {
namespace {

/// The most that the beam goes through on any of the cuts, mm.
double thickest(const TorchJob& job) {
  const TorchReach reach{.outer_radius = job.outer_radius,
                         .inner_radius = job.outer_radius - job.wall};
  double out = 0.0;
  for (const auto& cut : job.cuts)
    for (std::size_t i = 0; !cut.mark && i < cut.path.b.size(); ++i) {
      ask();
      out = std::max(out, metal_in_beam(reach, {.b = cut.path.b[i],
                                                .a = cut.still_lean       ? *cut.still_lean
                                                     : cut.path.a.empty() ? 0.0
                                                                          : cut.path.a[i],
                                                .on_flat = cut.on_flat || cut.still_lean}));
    }
  return out;
}

const ProcessRow& row_for(const MachineProcess& process, double metal) {
  constexpr double kRounding = 1e-9;  // mm, of the metal between two radii
  const ProcessRow* best = nullptr;
  double most = 0.0;
  for (const auto& row : process.rows) {
    most = std::max(most, row.metal);
    if (row.metal >= metal - kRounding && (best == nullptr || row.metal < best->metal)) best = &row;
  }
  if (best != nullptr) return *best;
  throw UnfitOption{"material", process.rows.front().material + " of " + process.machine +
                                    " goes up to " + mm(most) + ", the beam through " + mm(metal)};
}

/// Takes a value of the table if the request has no value; names those that the request has.
class Taker {
 public:
  void take(std::optional<double>& value, double of_table, std::string_view called) {
    if (!value)
      value = of_table;
    else if (*value != of_table)
      own_ += (own_.empty() ? "" : ", ") + std::string(called);
  }
  [[nodiscard]] const std::string& own() const { return own_; }

 private:
  std::string own_;
};

}  // namespace

void take_process(TorchJob& job, FormatOptions& o) {
  if (o.process == nullptr) return;
  const auto& process = *o.process;
  if (!in_ascii(process.machine))
    throw UnfitOption{"machine",
                      "a program is ASCII, and the machine's name has letters that have "
                      "no spelling in it"};
  const double metal = thickest(job);
  const auto& row = row_for(process, metal);
  if (!o.lead) job.shortest_lead = row.lead;
  Taker taker;
  taker.take(o.speed, row.speed, "feed");
  taker.take(o.lead, row.lead, "lead");
  const bool pairs = post_of(o).is_point_pairs();  // which have heights, and no axis
  if (process.pivot_length && !pairs)
    taker.take(o.pivot_length, *process.pivot_length, "pivot length");
  if (!post_of(o).of_control) {
    taker.take(o.pierce_delay, row.pierce_delay, "pierce delay");
    if (o.pivot_length || pairs) {
      taker.take(o.pierce_height, row.pierce_height, "pierce height");
      taker.take(o.cut_height, row.cut_height, "cutting height");
    }
  }
  if (process.clearance && o.pivot_length) taker.take(o.clearance, *process.clearance, "clearance");
  job.process.push_back("machine: " + process.machine + ", table " + process.sha256.substr(0, 16));
  const auto& post = post_of(o);
  job.process.push_back("process: " + row.material + " up to " + post.length(row.metal) +
                        ", the beam goes through " + post.length(metal) + " at most");
  if (!taker.own().empty())
    job.process.push_back("of the request, not of the table: " + taker.own());
  if (std::ranges::any_of(job.cuts,
                          [&](const auto& cut) { return !cut.mark && cut.kerf != row.kerf; }))
    job.process.push_back("kerf of the request, in the table it is " + post.length(row.kerf));
}

}  // namespace tubecut::api
