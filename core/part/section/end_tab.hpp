#pragma once

namespace tubecut::part {

/// A part of the wall of one face that goes on beyond a square cut, into a slot of the partner.
/// Lengths in mm.
struct EndTab {
  int face = 1;
  double offset = 0.0;  // of its middle from that of the face, as s grows in the part
  double width = 0.0;
  double length = 0.0;  // along the tube, from the cut
};

}  // namespace tubecut::part
