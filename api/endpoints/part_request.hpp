#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/endpoints/section_target.hpp"
#include "api/endpoints/tube_laser.hpp"
#include "api/wire/reader.hpp"
#include "core/part/member.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

/// A request for a part as a member of a node, or by its two ends; `resolve` fills in `part`.
struct PartRequest {
  Preset preset = Preset::none;
  part::PartSpec part;
  std::optional<part::MemberSpec> member = {};  // of a node
  std::optional<SectionTarget> section = {};    // of a tube that is not round, given directly
  part::SectionPartSpec of_section = {};        // filled in by `resolve` in place of `part`, except
                                                // the marks
  part::Datum datum = part::Datum::up;          // of a part given directly
  Angle seam = {};
  bool start_kerf = false, finish_kerf = false;  // an end has its own
  [[nodiscard]] bool seam_known() const {
    return (member ? member->datum : datum) == part::Datum::seam;
  }
  /// Once resolved, with those of the branches' holes.
  [[nodiscard]] const part::CutoutSpecs& cutouts() const {
    return section ? of_section.cutouts : part.cutouts;
  }
  // Once resolved, of a node:
  std::vector<std::size_t> start_cutters = {}, finish_cutters = {};
  std::vector<std::string> start_ids = {}, finish_ids = {};
  std::vector<Warning> warnings = {};
};

[[nodiscard]] PartRequest decode_part_request(Reader& in);

/// Errors  those of part::find_member and part::datum_angle; members as in the request.
[[nodiscard]] Result<PartRequest> resolve(PartRequest request);

/// The same issue or warning of core's part, naming the request's own members.
[[nodiscard]] Error on_request(const PartRequest& request, Error error);
[[nodiscard]] std::vector<Warning> on_request(const PartRequest& request,
                                              std::vector<Warning> warnings);

}  // namespace tubecut::api
