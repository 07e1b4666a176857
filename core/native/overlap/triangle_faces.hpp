// The faces into which another surface cuts a triangle, from the names of the nodes on them (mesh/plane_graph.hpp).
#pragma once

#include <vector>

#include "mesh/chains.hpp"
#include "mesh/plane_graph.hpp"
#include "overlap/meeting_nodes.hpp"

namespace satcheck {

class TriangleFaces {
 public:
  static constexpr std::uint32_t kOutside = 0xFFFFFFFF;

  // mesh: 0 or 1, as in `nodes`, which have all that are on the sides. segments: in the triangle, each once; they meet
  // only at common nodes. Those along a side are left out. The triangle must not be collinear.
  TriangleFaces(const MeetingNodes& nodes, int mesh, const Triangle& triangle, const Corners& corners,
                const std::vector<NodePair>& segments, Budget* budget);

  std::uint32_t count() const { return graph_.face_count() - 1; }

  // Half-edge 2 k runs along stretch k, 2 k + 1 back.
  std::uint32_t half_edge_count() const { return graph_.half_edge_count(); }
  std::uint32_t start(std::uint32_t h) const { return names_[graph_.start(h)]; }
  // The side in which a half-edge lies, or -1; and the face on its left.
  int side_of(std::uint32_t h) const { return graph_.segment(h) < 3 ? static_cast<int>(graph_.segment(h)) : -1; }
  std::uint32_t left(std::uint32_t h) const { return name_of(graph_.face(h)); }

  // A point inside a face; and the face that contains a point of the triangle that is on no stretch.
  ExactPoint sample(std::uint32_t face) const;
  std::uint32_t face_at(const ExactPoint& p) const;

 private:
  std::uint32_t name_of(std::uint32_t face) const {
    return face == outside_ ? kOutside : face < outside_ ? face : face - 1;
  }

  PlaneGraph graph_;
  std::uint32_t outside_ = 0;           // the face of the graph around the triangle
  std::vector<std::uint32_t> names_;    // of each node of the graph that of MeetingNodes
  std::vector<std::uint32_t> corners_;  // of the triangle: nodes of the graph
};

}  // namespace satcheck
