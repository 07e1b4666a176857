// A planar graph of segments in one plane, its half-edges and the faces between them.
//
// Method: Mark de Berg, Otfried Cheong, Marc van Kreveld, Mark Overmars, "Computational Geometry" (3rd ed. 2008),
// chapter 2. Where we deviate: nodes have names, a vertex, an edge of a mesh that meets the plane, or two segments that
// cross. Names of one point follow each other on a segment, where they become one node; no coordinates are compared
// with a tolerance. A part of the graph that is not connected with the rest lies in the innermost outline around it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/patches.hpp"
#include "exact/dyadic.hpp"
#include "exact/exact_point.hpp"
#include "exact/triangle_pair.hpp"

namespace satcheck {

// What changes from the left of a segment to its right: the number of triangles that cover the plane there, and the
// winding numbers of a surface just in front of the plane and behind it.
struct PlaneChange {
  int cover = 0, front = 0, back = 0;

  bool operator==(const PlaneChange&) const = default;
  PlaneChange operator-() const { return {-cover, -front, -back}; }
  PlaneChange& operator+=(const PlaneChange& c) {
    cover += c.cover;
    front += c.front;
    back += c.back;
    return *this;
  }
};
using PlaneChanges = std::array<PlaneChange, 2>;  // of two surfaces

class PlaneGraph {
 public:
  // plane: a triangle that is not collinear. Left and right are as seen from its front.
  PlaneGraph(const Corners& plane, Budget* budget);
  PlaneGraph(const PlaneGraph&) = delete;
  PlaneGraph& operator=(const PlaneGraph&) = delete;

  // A point in the plane, and the one where an edge pierces it.
  std::uint32_t vertex(Vec3 p);
  std::uint32_t piercing(Vec3 p, Vec3 q);
  // A point that the caller names.
  std::uint32_t add_node(const LazyPoint& p);
  // Equal segments become one.
  void add_segment(std::uint32_t from, std::uint32_t to, int surface, const PlaneChange& change);
  // A node inside a segment. build() finds it.
  void add_stop(std::uint32_t from, std::uint32_t to, std::uint32_t node);
  // Call one of them after the last segment. build_named: if segments meet at common nodes and stops only.
  void build();
  void build_named();

  int axis() const { return axis_; }
  int turn() const { return turn_; }
  const LazyPoint& node(std::uint32_t number) const { return nodes_[number]; }
  std::size_t node_count() const { return nodes_.size(); }
  // +1: left of the way from p to q.
  int side(std::uint32_t p, std::uint32_t q, const LazyPoint& of) const {
    return turn_ * orientation_2d_at(nodes_[p], nodes_[q], of, axis_, budget_);
  }

  // Half-edge 2 k runs along edge k, 2 k + 1 back. Each has a face on its left.
  std::uint32_t half_edge_count() const { return static_cast<std::uint32_t>(next_.size()); }
  std::uint32_t start(std::uint32_t h) const { return h % 2 ? edges_[h / 2].high : edges_[h / 2].low; }
  std::uint32_t end(std::uint32_t h) const { return start(h ^ 1); }
  // The first of the segments that run along it, by the order in which they were added.
  std::uint32_t segment(std::uint32_t h) const { return edges_[h / 2].segment; }
  std::uint32_t face(std::uint32_t h) const { return face_[outline_[h]]; }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(outlines_.size()); }
  // The face that contains a point; nothing for a point on a segment, or outside of all.
  std::optional<std::uint32_t> face_at(const LazyPoint& p) const;
  PlaneChanges changes(std::uint32_t h) const;
  // Any half-edge of a face, and all of them, one outline after another.
  std::uint32_t first(std::uint32_t face) const { return first_[outlines_[face][0]]; }
  template <class Visit>
  void visit(std::uint32_t face, Visit visit) const {
    for (const std::uint32_t outline : outlines_[face]) visit_outline(outline, visit);
  }
  // A point on the left of a half-edge, before any other segment; another one for each attempt. It lies on the way to
  // one of the nodes `corners`; empty if none is on the left.
  std::optional<ExactPoint> inside_left_of(std::uint32_t h, const std::vector<std::uint32_t>& corners, int attempt) const;

 private:
  struct Segment {
    std::uint32_t from, to;
    PlaneChanges changes;
    std::vector<std::uint32_t> stops;  // nodes inside it
  };
  struct Edge {
    std::uint32_t low, high;  // nodes
    std::uint32_t segment;
    bool forward;  // the segment runs from low to high
    PlaneChanges changes;
  };

  // The sign of node p's coordinate minus that of q.
  int compare(std::uint32_t p, std::uint32_t q, int axis) const { return compare_along(nodes_[p], nodes_[q], axis, budget_); }
  void meet_segments();
  void meet(std::uint32_t i, std::uint32_t k);
  void stop_at(std::uint32_t segment, std::uint32_t node);
  int axis_along(const Segment& s) const;
  void cut_segments();
  void sort_stops(Segment& s);
  void merge_edges();
  void trace();
  void find_faces();
  void join_outlines(DisjointSets& sets) const;
  template <class Visit>
  void visit_outline(std::uint32_t outline, Visit visit) const {
    std::uint32_t h = first_[outline];
    do {
      visit(h);
      h = next_[h];
    } while (h != first_[outline]);
  }
  std::optional<int> winding(std::uint32_t outline, const LazyPoint& p) const;
  bool is_within(std::uint32_t outline, std::uint32_t other) const;
  std::optional<std::uint32_t> outline_around(const LazyPoint& p, std::uint32_t other_than) const;
  void sort_around(std::vector<std::uint32_t>& half_edges) const;
  std::uint32_t far_end(std::uint32_t h) const;
  Ratio clear_way(const LazyPoint& from, const LazyPoint& to) const;

  Corners plane_;
  int axis_, turn_;
  Budget* budget_;
  std::vector<LazyPoint> nodes_;
  std::map<std::array<double, 3>, std::uint32_t> vertices_;
  std::map<std::array<double, 6>, std::uint32_t> piercings_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> segment_of_;
  std::vector<Segment> segments_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> same_;  // names of one point
  std::vector<std::uint32_t> part_;  // of each node: a node of its connected part
  std::vector<Edge> edges_;
  // An outline: what is on the left of half-edges that follow each other.
  std::vector<std::uint32_t> next_, outline_;         // of each half-edge
  std::vector<std::uint32_t> first_, face_;           // of each outline: a half-edge, and the face
  std::vector<Aabb> boxes_;                           // of each outline
  std::vector<std::vector<std::uint32_t>> outlines_;  // of each face
};

}  // namespace satcheck
