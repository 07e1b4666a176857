#include "mesh_pair/samples.hpp"

namespace satcheck {

bool Samples::note_free(const Side& side, std::uint32_t t, const ExactPoint& p, int theirs) {
  const auto mine = beside(side.self, p, corners(side.self.mesh, t), side.budget);
  if (!mine) return false;
  note_beside(side, *mine, {theirs, theirs}, [&] { return side.evidence(t, kNoTriangle, p.rounded); });
  return true;
}

bool Samples::note_at(const Side& side, std::uint32_t t, std::uint32_t partner, const ExactPoint& p) {
  const Corners c = corners(side.self.mesh, t);
  const auto theirs = beside(side.other, p, c, side.budget);
  if (!theirs) return false;
  const auto mine = beside(side.self, p, c, side.budget);
  if (!mine) return false;
  note_beside(side, *mine, *theirs, [&] { return side.evidence(t, partner, p.rounded); });
  return true;
}

}  // namespace satcheck
