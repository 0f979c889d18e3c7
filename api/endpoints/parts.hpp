#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/cutouts/cutout_codec.hpp"
#include "api/endpoints/part_request.hpp"
#include "api/endpoints/tube_laser.hpp"
#include "api/limits.hpp"
#include "api/verdict.hpp"
#include "api/wire/check_limit.hpp"
#include "api/wire/format.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {

/// /v1/parts, as an endpoint and for every member of a frame: see pipeline.hpp.
struct Parts {
  using Spec = PartRequest;
  struct Laser {
    EndReport start, finish;
    part::Webs webs;
  };
  struct Out : part::Part {
    std::optional<Laser> laser = {};
    std::optional<part::SectionPart> of_section = {};  // instead of the rest
  };
  static constexpr std::string_view kId = "parts";
  static constexpr std::string_view kPath = "/v1/parts";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_large_max_bytes);
  static constexpr double kBudgetS = kLongBudgetS;
  static constexpr auto kAccepts =
      joined(std::array<std::string_view, 3>{"max_root_gap_mm", "max_extra_bevel_deg", "max_b_deg"},
             kEndAccepts, kPartAccepts, kCutoutAccepts);
  static constexpr auto kOwnChecks = std::to_array<CheckLimit>({
      {"hole_on_branch", "1e-6", "mm"},
      {"hole_gap", "1e-6", "mm"},
      {"hole_fit_up", "1e-6", "mm"},
      {"hole_dihedral", "1e-6", "deg"},
      {"hole_groove", "1e-6", "deg"},
      {"hole_tilt", "1e-6", "deg"},
      {"hole_kerf", "1e-6", "mm"},
      {"hole_branch_end", "1e-6", "mm"},
      {"hole_gap_stated", "1e-3", "mm"},
      {"hole_gap_between", "sampling.tolerance_mm", "mm"},
      {"hole_gouge", "0.01", "mm"},
      {"hole_gouge_stated", "1e-3", "mm"},
      {"hole_left_stated", "max(5e-3, 0.02 left_mm)", "mm"},
      {"cutout_edge", "1e-9", "mm"},
      {"cutout_gouge", "0.01", "mm"},
      {"square_hole_gap", "1e-3", "mm"},
      {"cutout_volume", "1e-9, of itself", ""},
      {"on_section", "1e-9", "mm"},
      {"tab_corners", "1e-6", "mm"},
      {"tab_beam", "0.01", "mm"},
      {"tab_area", "1e-6", "mm"},
      {"placed", "1e-9 max(1, 1e-3 (radius + length))", "mm"},
      {"volume", "1e-9, of itself", ""},
      {"check_dimensions", "1e-9 max(1, 1e-3 (radius + length))", "mm"},
  });
  static constexpr auto kChecks = joined(kTableChecks, kOwnChecks);

  static Spec decode(Reader& in);
  static Result<Spec> resolve(Spec spec);
  static Result<Out> compute(const Spec& spec);
  static std::vector<Check> verify(const Spec& spec, const Out& out);
  static std::vector<Warning> warnings(const Spec& spec, const Out& out);
  static std::vector<Measure> measure(const Spec& spec, const Out& out);
  static void encode(const Spec& spec, const Out& out, Writer& w);
  static const std::vector<Format<Spec, Out>>& formats();
};

}  // namespace tubecut::api
