#include "mesh_pair/samples.hpp"

namespace satcheck {

bool Samples::note_free(const Side& side, std::uint32_t t, const ExactPoint& p, int theirs) {
  const Evidence where = side.evidence(t, kNoTriangle, p.rounded);
  if (!side.self.solid) {
    note(side, 1, theirs, where);
    return true;
  }
  const auto mine = beside(side.self, p, corners(side.self.mesh, t));
  if (!mine) return false;
  note(side, mine->front, theirs, where);
  note(side, mine->back, theirs, where);
  return true;
}

bool Samples::note_at(const Side& side, std::uint32_t t, std::uint32_t partner, const ExactPoint& p) {
  const Corners c = corners(side.self.mesh, t);
  const Evidence where = side.evidence(t, partner, p.rounded);
  const auto theirs = beside(side.other, p, c);
  if (!theirs) return false;
  if (!side.self.solid) {
    // A sheet in the boundary of the other body is neither inside nor outside.
    if ((theirs->front == 0) == (theirs->back == 0)) note(side, 1, theirs->front, where);
    if (theirs->is_boundary()) note_contact(where);
    return true;
  }
  const auto mine = beside(side.self, p, c);
  if (!mine) return false;
  note(side, mine->front, theirs->front, where);
  note(side, mine->back, theirs->back, where);
  if (mine->is_boundary() && theirs->is_boundary()) note_contact(where);
  return true;
}

}  // namespace satcheck
