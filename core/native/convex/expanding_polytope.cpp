#include "convex/expanding_polytope.hpp"

namespace satcheck {

void ExpandingPolytope::grow() {
  room_ = 2 * std::max(2 * blocks_used_, vertices_used_) + 32;
  blocks_.resize(room_);
  faces_in_.resize(room_);
  free_.resize(room_);
  fan_.resize(room_);
  vertices_.resize(room_);
  const std::size_t edges = 4 * room_ + 4;
  horizon_.resize(edges);
  tails_.resize(edges);
  pending_.resize(edges);
}

}  // namespace satcheck
