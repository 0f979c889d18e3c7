/** Limits of one import, so that no file blocks its user. */
export const limits = {
  members: 10000, // of a frame, by the contract
  others: 1000, // the same
  listed: 20000, // things in the list
  depth: 64, // of items, curves and units in one another
  clips: 1000, // cuts of one body, each in the next
  steps: 200000, // bodies that are looked at in one file
  points: 10000, // of one curve or polyline
  statement: 400000, // bytes of one entity of IFC: 20 000 references
  lines: 1000000, // of an NC1 file
  cutouts: 2000, // of a part, by the contract
  pieces: 500, // of a cut-out's contour, the same
} as const;
