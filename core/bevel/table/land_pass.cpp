#include "core/bevel/table/land_pass.hpp"

#include <string>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/bevel/beam/torch_line.hpp"
#include "core/bevel/table/table_parts.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kEven = 1e-9;  // of the wall: where the land and the bevel are one line

Issue no_pass(const char* why, double phi) {
  return {.code = ErrorCode::unsupported_combination,
          .member = "root_face",
          .hint = std::string(why) + ", at phi " + brief(phi * kDegPerRad) + " deg"};
}

}  // namespace

Result<Table> land_pass(const TableSpec& spec, const Table& table) {
  auto alone = spec;
  alone.root_face = 0.0;
  auto out = table;
  out.z_face.clear();
  out.b_face.clear();
  out.b = table.b_face;
  for (std::size_t i = 0; i < out.b.size(); ++i) {
    const double b = out.b[i], wall = spec.target.wall;
    if (b < spec.torch.min.rad() || b > spec.torch.max.rad())
      return fail(no_pass("the land leans further than the torch", out.phi[i]));
    out.z_outer[i] = out.z_inner[i] + wall * elementary::tan(b);
    out.beam[i] = wall / elementary::cos(b);
    if (out.z_outer[i] > table.z_outer[i] + kEven * wall)
      return fail(no_pass("the land leans further into the part than the bevel", out.phi[i]));
  }
  const auto line = torch_line(alone, out);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  detail::fill_torch(alone, line.drops, out);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  TRY(check_spared(beam_cut(alone, out), out.torch_line));
  return out;
}

}  // namespace tubecut::bevel
