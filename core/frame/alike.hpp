#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/joint/placement.hpp"
#include "core/part/part.hpp"

namespace tubecut::frame {

/// Differences below this are none, whatever is asked for: numbers are written to 1e-6 mm, and a
/// shallow cut makes ten times as much of it.
inline constexpr double kLeastAlike = 1e-5;  // mm

/// A member's part as it is asked for, and what of it must be another's to the letter.
struct Shape {
  std::size_t form = 0;  // of the parts that are asked for; members of one form share it
  std::string key;       // the tube, and how both ends are cut
  std::vector<std::string> start, finish;  // of each partner
  std::vector<std::string> holes, marks;   // of each, with the part that stands there
};

/// How the part that represents a group becomes one of its members: turned back by `turn` about
/// its axis, then moved by `shift` along it, both in the member's start frame.
struct Laid {
  Angle turn;
  double shift = 0.0;                      // mm
  double differs = 0.0;                    // the surfaces' distance is at most this, mm
  std::vector<std::size_t> start, finish;  // of the member's partners each the other's
  std::vector<std::size_t> holes, marks;

  /// The start frame of the part that represents the group, as this member.
  [[nodiscard]] joint::MemberFrame stand(const joint::MemberFrame& own) const;
};

struct AlikeGroup {
  std::size_t by = 0;                                // the shape that represents it
  std::vector<std::pair<std::size_t, Laid>> shapes;  // ascending, `by` among them
};

/// Groups of parts whose finished surfaces differ nowhere by more than `within` (at least
/// kLeastAlike) from the part that represents their group, turned about its axis and moved along
/// it as fits; never mirrored, nor end for end. What was compared once is not compared again.
///
/// What is compared is the finished wall itself, edge by edge at the same phase: at kAlikePhases of
/// each end, half as many of each hole, and the places of the marks; what may lie between two
/// phases is counted by second differences. The sampling's own rows play no part.
///
/// Which parts are one depends neither on the order of the shapes nor on where the frame stands:
/// a group is gathered round the middle one by the length that is left between both cuts.
class Gatherer {
 public:
  /// `forms`: each part as it is asked for, nullptr where it cannot be read: it is alike to its own
  /// form alone. `texts`: of each form, which break ties.
  Gatherer(std::span<const part::PartSpec* const> forms, std::span<const std::string> texts,
           double within);
  ~Gatherer();
  Gatherer(const Gatherer&) = delete;
  Gatherer& operator=(const Gatherer&) = delete;

  /// Errors  cancelled.
  /// Cost    about 2 ms for each end and hole of a form that another one resembles; 50 us for each
  ///         form else.
  [[nodiscard]] Result<std::vector<AlikeGroup>> groups(std::span<const Shape> shapes,
                                                       const std::stop_token& stop = {});

 private:
  class Known;
  std::unique_ptr<Known> known_;
};

inline constexpr std::size_t kAlikePhases = 360;

}  // namespace tubecut::frame
