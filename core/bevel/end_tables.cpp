#include "core/bevel/end_tables.hpp"

#include "core/base/try.hpp"

namespace tubecut::bevel {
namespace {

/// Nothing about one end alone.
bool spoils_all(ErrorCode code) {
  return code == ErrorCode::too_many_nodes || code == ErrorCode::cancelled;
}

Result<EndTable> end_table(const joint::NodeSpec& spec, const joint::MemberEnd& end,
                           const TableSpec& asked, const std::stop_token& stop) {
  auto joint = joint::joint_of(spec, end);
  EndTable out{.spec = asked, .table = {}, .refused = {}};
  out.spec.target = joint.target;
  out.spec.partners = std::move(joint.partners);
  out.spec.stated = std::move(joint.stated);
  auto made = table(out.spec, stop);
  if (made) {
    out.table = *std::move(made);
  } else if (spoils_all(made.error().code())) {
    return tl::unexpected(made.error());
  } else {
    out.refused = made.error().issues.front();
  }
  return out;
}

}  // namespace

Result<std::vector<std::optional<EndTable>>> end_tables(const joint::NodeSpec& spec,
                                                        const joint::Nodes& nodes,
                                                        const TableSpec& asked,
                                                        const std::stop_token& stop) {
  TRY(check_groove(asked.groove));
  std::vector<std::optional<EndTable>> out(nodes.ends.size());
  auto left = asked;
  for (std::size_t i = 0; i < nodes.ends.size(); ++i) {
    const auto& end = nodes.ends[i];
    if (end.cut_by.empty() || end.open || end.consumed) continue;
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    TRY(auto one, end_table(spec, end, left, stop));
    const auto used = one.table ? one.table->phi.size() : 0;
    if (used > left.sampling.max_nodes)
      return fail(
          {.code = ErrorCode::too_many_nodes,
           .member = "sampling",
           .got = static_cast<double>(asked.sampling.max_nodes - left.sampling.max_nodes + used),
           .limit = static_cast<double>(asked.sampling.max_nodes)});
    left.sampling.max_nodes -= used;
    out[i] = std::move(one);
  }
  return out;
}

}  // namespace tubecut::bevel
