#include "core/bevel/table/end_tables.hpp"

#include <algorithm>
#include <utility>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"

namespace tubecut::bevel {
namespace {

/// Returns true for errors that do not concern a single end.
bool fails_whole_request(ErrorCode code) {
  return code == ErrorCode::too_many_nodes || code == ErrorCode::cancelled;
}

Result<EndTable> end_table(const joint::NodeSpec& spec, const joint::MemberEnd& end,
                           const TableSpec& asked) {
  auto joint = joint::joint_of(spec, end);
  EndTable out{.spec = asked, .table = {}, .refused = {}};
  out.spec.target = joint.target;
  out.spec.partners = std::move(joint.partners);
  out.spec.stated = std::move(joint.stated);
  out.section = joint.section;
  const auto keep = [&]<class T>(Result<T> made, std::optional<T>& where) -> Result<void> {
    if (made)
      where = *std::move(made);
    else if (fails_whole_request(made.error().code()))
      return tl::unexpected(made.error());
    else
      out.refused = made.error().issues.front();
    return {};
  };
  if (out.section)
    TRY(keep(section_table(*out.section, out.spec), out.of_section));
  else
    TRY(keep(table(out.spec), out.table));
  return out;
}

/// The tables of a node share the nodes that a request may have.
class SharedNodes {
 public:
  explicit SharedNodes(const TableSpec& asked)
      : asked_(asked.sampling.max_nodes),
        largest_(asked.sampling.tolerance ? asked_ : asked.sampling.uniform_points),
        left_(asked) {}

  /// Returns the spec of a table that may use all remaining nodes.
  [[nodiscard]] const TableSpec& left() const { return left_; }

  /// Returns the number of tables to compute at a time: the remaining nodes suffice for twice the
  /// largest so far.
  [[nodiscard]] std::size_t tables() const {
    constexpr std::size_t kMost = 64;
    const auto each = 2 * std::max<std::size_t>(1, largest_);
    return std::clamp<std::size_t>(left_.sampling.max_nodes / each, 1, kMost);
  }

  [[nodiscard]] bool has(const EndTable& one) const {
    return nodes_of(one) <= left_.sampling.max_nodes;
  }

  Result<EndTable> take(EndTable one) {
    const auto used = nodes_of(one);
    if (!has(one))
      return fail({.code = ErrorCode::too_many_nodes,
                   .member = "sampling",
                   .got = static_cast<double>(asked_ - left_.sampling.max_nodes + used),
                   .limit = static_cast<double>(asked_)});
    left_.sampling.max_nodes -= used;
    largest_ = first_ ? used : std::max(largest_, used);
    first_ = false;
    return one;
  }

 private:
  static std::size_t nodes_of(const EndTable& one) {
    if (one.of_section) return one.of_section->at.size();
    return one.table ? one.table->phi.size() : 0;
  }

  std::size_t asked_;
  std::size_t largest_;  // of one table; before the first, from the request
  bool first_ = true;
  TableSpec left_;
};

}  // namespace

Result<std::vector<std::optional<EndTable>>> end_tables(const joint::NodeSpec& spec,
                                                        const joint::Nodes& nodes,
                                                        const TableSpec& asked,
                                                        const ParallelFor& parallel_for) {
  TRY(check_groove(asked.groove));
  std::vector<std::size_t> cut;
  for (std::size_t i = 0; i < nodes.ends.size(); ++i)
    if (const auto& end = nodes.ends[i]; !end.cut_by.empty() && !end.open && !end.consumed)
      cut.push_back(i);
  std::vector<std::optional<EndTable>> out(nodes.ends.size());
  SharedNodes shared(asked);
  for (std::size_t from = 0; from < cut.size();) {
    std::vector<std::optional<Result<EndTable>>> made(std::min(shared.tables(), cut.size() - from));
    parallel_for(made.size(), [&](std::size_t k) {
      if (!stopped()) made[k] = end_table(spec, nodes.ends[cut[from + k]], shared.left());
    });
    for (auto& one : made) {
      if (stopped() || !one) return fail({.code = ErrorCode::cancelled});
      const auto end = cut[from++];
      // If a table needs more nodes than those before it left, compute it again with the remaining
      // nodes, as in a sequential run.
      if (&one != made.data() && (!*one || !shared.has(**one)))
        one = end_table(spec, nodes.ends[end], shared.left());
      TRY(auto table, *std::move(one));
      TRY(out[end], shared.take(std::move(table)));
    }
  }
  return out;
}

}  // namespace tubecut::bevel
