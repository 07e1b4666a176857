// The faces into which another surface cuts a triangle: a planar graph, traced by its half-edges.
//
// Method: Mark de Berg, Otfried Cheong, Marc van Kreveld, Mark Overmars, "Computational Geometry" (3rd ed. 2008),
// chapter 2: the next half-edge in clockwise order at its end continues the same face. Where we deviate: unconnected
// parts of the graph are joined to their faces by segments across the triangle and not by a sweep.
#pragma once

#include <optional>
#include <vector>

#include "exact/ratio.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/chains.hpp"
#include "overlap/meeting_nodes.hpp"

namespace satcheck {

class TriangleFaces {
 public:
  static constexpr std::uint32_t kOutside = 0xFFFFFFFF;

  // border: the nodes around the triangle, counter-clockwise. inner: stretches within it, each once; they meet only at
  // common nodes. The triangle must not be collinear.
  TriangleFaces(const MeetingNodes& nodes, const Corners& triangle, const std::vector<std::uint32_t>& border,
                const std::vector<NodePair>& inner, Budget* budget);

  // Whether all faces are known. False: no tried segment across the triangle avoids all nodes.
  bool complete() const { return complete_; }
  std::uint32_t count() const { return count_; }

  // The border's stretches come first. Half-edge 2 k runs along stretch k, 2 k + 1 back.
  const std::vector<NodePair>& stretches() const { return stretches_; }
  std::size_t border_count() const { return border_count_; }
  // The face on the left of a half-edge.
  std::uint32_t left(std::size_t half_edge) const { return face_[half_edge]; }

  // A point inside a face; and the face that contains a point of the triangle that is on no stretch.
  std::optional<ExactPoint> sample(std::uint32_t face) const;
  std::optional<std::uint32_t> face_at(const ExactPoint& p) const;

 private:
  struct Crossing {
    Ratio at;                // on the way
    std::uint32_t near_side;  // the half-edge that has the way up to here on its left
  };

  const ExactPoint& node(std::uint32_t number) const { return nodes_->at(number); }
  std::uint32_t start(std::uint32_t h) const { return h % 2 ? stretches_[h / 2].second : stretches_[h / 2].first; }
  std::uint32_t end(std::uint32_t h) const { return start(h ^ 1); }
  int side(const ExactPoint& p, const ExactPoint& q, const ExactPoint& of) const {
    return turn_ * orientation_2d_at(p, q, of, axis_);
  }

  void trace();
  void sort_around(std::vector<std::uint32_t>& half_edges) const;
  std::vector<std::vector<std::uint32_t>> islands() const;
  bool join_islands(std::vector<std::uint32_t>& loop_of) const;
  ExactPoint middle(std::uint32_t stretch) const;
  ExactPoint beyond(const ExactPoint& from, int attempt) const;
  std::optional<std::vector<Crossing>> crossings(const ExactPoint& from, const ExactPoint& to) const;

  const MeetingNodes* nodes_;
  Corners corners_;
  Budget* budget_;
  int axis_, turn_;
  std::vector<NodePair> stretches_;
  std::size_t border_count_;
  std::vector<std::uint32_t> face_;  // by half-edge
  std::uint32_t count_ = 0;
  bool complete_ = true;
};

}  // namespace satcheck
