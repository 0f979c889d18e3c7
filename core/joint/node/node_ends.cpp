#include <string>
#include <utility>

#include "core/base/try.hpp"
#include "core/joint/node/end_curves.hpp"
#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/overlap.hpp"

namespace tubecut::joint {

std::string place_of(std::size_t member, End end) {
  return "members/" + std::to_string(member) + (end == End::start ? "/start" : "/end");
}

Partner partner_of(const CutBy& cut) {
  if (cut.plane) return *cut.plane;
  if (cut.box) return *cut.box;
  return cut.placement.tube;
}

detail::Seat detail::seat_of(const CutBy& cut) {
  const double by = seat(cut.stated, 0.0, 0.0);
  if (cut.plane) return grown(Seat(*cut.plane), by);
  if (cut.box) return grown(Seat(*cut.box), by);
  return grown(Seat(cut.placement.tube), by);
}

std::vector<PreparedCutter> detail::prepared_seats(const MemberEnd& end) {
  std::vector<PreparedCutter> out;
  for (const auto& cut : end.cut_by)
    if (auto one = by_kind(seat_of(cut), [](const Cutter& cutter) { return prepare(cutter); }))
      out.push_back(*one);
  return out;
}

std::vector<Partner> seats(const EndJoint& joint) {
  std::vector<Partner> out;
  for (std::size_t i = 0; i < joint.partners.size(); ++i)
    out.push_back(grown(joint.partners[i], seat(joint.stated[i], 0.0, 0.0)));
  return out;
}

EndJoint joint_of(const NodeSpec& spec, const MemberEnd& end) {
  const auto& m = spec.members[end.member];
  EndJoint out{.target = {.outer_radius = m.half_size(),
                          .wall = m.thickness(),
                          .length = (m.finish - m.start).norm()},
               .partners = {},
               .stated = {},
               .member = end.member,
               .cutters = {},
               .warnings = {},
               .section = m.section};
  for (const auto& cut : end.cut_by) {
    out.partners.push_back(partner_of(cut));
    out.stated.push_back(cut.stated);
    out.cutters.push_back(cut.member);
  }
  return out;
}

Result<EndJoint> joint_at(const NodeSpec& spec, std::size_t member, End end) {
  TRY(const auto nodes, solve(spec));
  const auto at = place_of(member, end);
  const auto& found = nodes.ends[2 * member + (end == End::finish ? 1 : 0)];
  if (found.cut_by.empty())
    return fail({.code = ErrorCode::no_contact,
                 .member = at,
                 .hint = found.free ? "this end joins no member"
                                    : "no member that joins this end cuts it"});
  auto out = joint_of(spec, found);
  for (const auto& warning : nodes.warnings)
    if (warning.member == at && warning.code != WarningCode::near_parallel)
      out.warnings.push_back(warning);
  TRY(const auto shared, overlaps(spec, nodes, member));
  for (auto& warning : warnings_of(spec, shared, member))
    out.warnings.push_back(std::move(warning));
  return out;
}

Result<EndCurves> curves(const IntersectionSpec& spec,
                         const std::optional<section::Section>& section) {
  if (!section) {
    TRY(auto round, intersect(spec));
    return EndCurves{std::move(round)};
  }
  TRY(auto made, intersect(*section, spec));
  EndCurves out{{.profiles = {}, .warnings = made.warnings}};
  out.of_section = std::move(made);
  return out;
}

std::vector<Check> verify(const IntersectionSpec& spec,
                          const std::optional<section::Section>& section, const EndCurves& answer) {
  if (section) return verify(*section, spec, *answer.of_section);
  return verify(spec, answer);
}

namespace {

std::size_t rows_of(const EndCurves& curves) {
  std::size_t out = 0;
  for (const auto& profile : curves.profiles) out += profile.phi.size();
  if (curves.of_section)
    for (const auto& profile : curves.of_section->profiles) out += profile.z.size();
  return out;
}

}  // namespace

Result<std::vector<std::optional<EndCurves>>> profiles(const NodeSpec& spec, const Nodes& nodes,
                                                       const Sampling& sampling) {
  std::vector<std::optional<EndCurves>> out(nodes.ends.size());
  auto left = sampling;
  for (std::size_t i = 0; i < nodes.ends.size(); ++i) {
    const auto& end = nodes.ends[i];
    if (end.cut_by.empty() || end.open || end.consumed) continue;
    const auto joint = joint_of(spec, end);
    IntersectionSpec asked{.target = joint.target, .partners = seats(joint), .sampling = left};
    asked.surfaces = Surfaces::both;
    auto made = curves(asked, joint.section);
    // A wall flush with its partners may pass them outside by rounding; its bore meets them.
    if (!made && end.overhangs && made.error().code() == ErrorCode::open_profile) {
      asked.surfaces = Surfaces::inner;
      made = curves(asked, joint.section);
    }
    if (!made) {
      const auto code = made.error().code();
      if (code == ErrorCode::member_consumed || code == ErrorCode::open_profile ||
          code == ErrorCode::no_contact)
        continue;
      return tl::unexpected(made.error());
    }
    const auto used = rows_of(*made);
    if (used > left.max_nodes)
      return fail({.code = ErrorCode::too_many_nodes,
                   .member = "sampling",
                   .got = static_cast<double>(sampling.max_nodes - left.max_nodes + used),
                   .limit = static_cast<double>(sampling.max_nodes)});
    left.max_nodes -= used;
    out[i] = *std::move(made);
  }
  return out;
}

}  // namespace tubecut::joint
