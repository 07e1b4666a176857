#include "convex/expanding_polytope.hpp"

namespace satcheck {

ExpandingPolytope& ExpandingPolytope::of_thread() {
  thread_local ExpandingPolytope polytope;
  return polytope;
}

void ExpandingPolytope::grow() {
  room_ = 2 * std::max(2 * blocks_used_, vertices_used_) + 32;
  blocks_.resize(room_);
  faces_in_.resize(room_);
  free_.resize(room_);
  fan_.resize(room_);
  vertices_.resize(room_);
  const std::size_t edges = 4 * room_ + 8;
  horizon_.resize(edges);
  tails_.resize(edges);
  pending_.resize(edges);
}

}  // namespace satcheck
