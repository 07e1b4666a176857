// The faces into which another surface cuts a triangle, from the names of the nodes on them (mesh/plane_graph.hpp).
//
// Unconnected parts of the graph are joined to their faces by segments across the triangle.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/patches.hpp"
#include "exact/ratio.hpp"
#include "mesh/chains.hpp"
#include "mesh/plane_graph.hpp"
#include "overlap/meeting_nodes.hpp"

namespace satcheck {

class TriangleFaces {
 public:
  static constexpr std::uint32_t kOutside = 0xFFFFFFFF;

  // The nodes on a side of the triangle.
  struct TriangleSide {
    std::uint32_t from, to;
    std::vector<std::uint32_t> inside;
  };

  // segments: in the triangle, each once; they meet only at common nodes. Those along a side are left out. The triangle
  // must not be collinear.
  TriangleFaces(const MeetingNodes& nodes, const Corners& triangle, const std::array<TriangleSide, 3>& sides,
                const std::vector<NodePair>& segments, Budget* budget);

  // Whether all faces are known. False: no tried segment across the triangle avoids all nodes.
  bool complete() const { return complete_; }
  std::uint32_t count() const { return count_; }

  // Half-edge 2 k runs along stretch k, 2 k + 1 back. The stretches of the sides come first, counter-clockwise.
  std::size_t half_edge_count() const { return 2 * forward_.size(); }
  std::uint32_t start(std::size_t h) const { return names_[graph_.start(in_graph(h))]; }
  // The side in which a half-edge lies, or -1; and the face on its left.
  int side_of(std::size_t h) const { return h / 2 < side_.size() ? side_[h / 2] : -1; }
  std::uint32_t left(std::size_t h) const { return face_[graph_.outline(in_graph(h))]; }

  // A point inside a face; and the face that contains a point of the triangle that is on no stretch.
  std::optional<ExactPoint> sample(std::uint32_t face) const;
  std::optional<std::uint32_t> face_at(const ExactPoint& p) const;

 private:
  struct Crossing {
    Ratio at;                // on the way
    std::uint32_t near_side;  // the half-edge of the graph that has the way up to here on its left
  };

  std::uint32_t in_graph(std::size_t h) const { return forward_[h / 2] ^ static_cast<std::uint32_t>(h % 2); }
  void make_graph(const MeetingNodes& nodes, const std::array<TriangleSide, 3>& sides, const std::vector<NodePair>& segments);
  bool join_islands(DisjointSets& outlines) const;
  ExactPoint middle(std::uint32_t half_edge) const;
  ExactPoint beyond(const ExactPoint& from, int attempt) const;
  std::optional<std::vector<Crossing>> crossings(const ExactPoint& from, const ExactPoint& to) const;

  Corners corners_;
  Budget* budget_;
  PlaneGraph graph_;
  std::vector<std::uint32_t> names_;    // of each node of the graph that of MeetingNodes
  std::vector<std::uint32_t> forward_;  // of each stretch the half-edge of the graph
  std::vector<int> side_;               // of each stretch of a side
  std::vector<std::uint32_t> face_;     // by outline
  std::uint32_t count_ = 0;
  bool complete_ = true;
};

}  // namespace satcheck
