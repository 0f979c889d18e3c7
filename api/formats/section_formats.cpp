#include "api/formats/section_formats.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "api/formats/csv.hpp"
#include "api/wire/joint_names.hpp"
#include "api/wire/section_tables.hpp"

namespace tubecut::api {

std::string section_csv(const joint::SectionIntersection& cut, const Caption& caption) {
  double tip = std::ranges::min(cut.profiles.front().z);  // on the outside, if that is there
  for (const auto& p : cut.profiles)
    if (p.outer) tip = std::ranges::min(p.z);
  std::vector<std::pair<std::string, Columns>> surfaces;
  for (const auto& p : cut.profiles) {
    auto drop = p.z;
    for (double& z : drop) z -= tip;
    surfaces.emplace_back(wall_name(p.outer),
                          profile_columns(p).column("drop_mm", std::move(drop)));
  }
  return Csv(caption).stacked("surface", surfaces).print();
}

std::string section_bevel_csv(const bevel::TableSpec& spec, const bevel::SectionTable& table,
                              const std::vector<std::string>& columns, const Caption& caption) {
  return Csv(caption)
      .remark("b_sign: outer_edge_into_part")
      .table(bevel_columns(spec, table).only(columns))
      .print();
}

UnfitOption no_format_of_section(std::string_view offered) {
  return {.name = "format",
          .hint =
              "this format prints round targets only; a rectangular_tube or flat_oval_tube is "
              "printed as json, cbor, " +
              std::string(offered)};
}

}  // namespace tubecut::api
