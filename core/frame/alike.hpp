#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/joint/placement.hpp"
#include "core/part/part.hpp"
#include "core/section/section.hpp"

namespace tubecut::frame {

/// The smallest permitted tolerance: smaller differences count as 0, because numbers are written to
/// 1e-6 mm and a shallow cut multiplies that by ten.
inline constexpr double kLeastAlike = 1e-5;  // mm

/// A member's part as requested, with keys that must be identical in alike parts.
struct Shape {
  std::size_t form = 0;  // index of a requested part; members of one form share it
  std::string key;       // the tube, and how both ends are cut
  std::vector<std::string> start, finish;             // of each partner
  std::vector<double> start_missing, finish_missing;  // of each: how far the cut follows it beyond
                                                      // its metal, mm
  std::vector<std::string> holes, marks;              // of each, with the part that is placed there
  bool has_cutouts = false;  // or texts or square holes, so a part is only alike as it stands; all
                             // but the places of the holes are in the key
};

/// A part as requested. Of a tube that is not round, `section` is its outline, and the part's
/// target is a round tube of the same girth, by which places round it are compared.
struct AskedPart {
  const part::PartSpec* part = nullptr;  // nullptr: it is invalid, and alike only to its own form
  const section::Section* section = nullptr;
};

/// Transforms the part that represents a group into one of its members: rotate it back by `turn`
/// about its axis, then move it by `shift` along it, both in the member's start frame.
struct Laid {
  Angle turn;
  double shift = 0.0;    // mm
  double differs = 0.0;  // maximum distance of the surfaces, mm
  std::vector<std::size_t> start,
      finish;  // for each partner of the member, the index of the matching one
  std::vector<std::size_t> holes, marks;

  /// Returns the start frame of the representing part, placed as this member.
  [[nodiscard]] joint::MemberFrame stand(const joint::MemberFrame& own) const;
};

struct AlikeGroup {
  std::size_t by = 0;                                // the shape that represents the group
  std::vector<std::pair<std::size_t, Laid>> shapes;  // ascending, includes `by`
};

/// Groups parts whose finished surfaces differ by at most `within` (at least kLeastAlike)
/// everywhere from the part that represents their group, after a rotation about its axis and a move
/// along it; never mirrored or end for end. A tube that is not round is rotated by half turns, a
/// square one by quarters. Each comparison is made only once.
///
/// The finished walls are compared edge by edge at equal phases: kAlikePhases at each end, half as
/// many at each hole, and the positions of the marks. Second differences bound the difference
/// between two phases. Where an edge jumps, two of them differ by the distance of their jumps, not
/// by the jumps' height. The sampling's own rows do not matter.
///
/// The groups depend neither on the order of the shapes nor on the position of the frame, because
/// each group is gathered around the one that is in the middle by length between both cuts.
class Gatherer {
 public:
  /// `texts`: of each form; they break ties.
  Gatherer(std::span<const AskedPart> forms, std::span<const std::string> texts, double within);
  ~Gatherer();
  Gatherer(const Gatherer&) = delete;
  Gatherer& operator=(const Gatherer&) = delete;

  /// Errors  cancelled.
  /// Cost    about 2 ms for each end and hole of a form that another one resembles; 50 us for each
  ///         other form.
  [[nodiscard]] Result<std::vector<AlikeGroup>> groups(std::span<const Shape> shapes);

 private:
  class Known;
  std::unique_ptr<Known> known_;
};

inline constexpr std::size_t kAlikePhases = 360;

}  // namespace tubecut::frame
