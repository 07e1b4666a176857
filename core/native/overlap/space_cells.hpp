// The cells into which two closed surfaces cut space, by the sides of the faces that bound them.
//
// Each surface cuts the triangles of the other into faces. Faces end at stretches. Faces that follow each other in a
// rotation about a stretch bound a common cell (around_stretch.hpp). In this way the sides of the faces join into the
// closed surfaces that bound the cells. Each of these is a shell. A cell with cavities has several shells.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "base/patches.hpp"
#include "mesh/chains.hpp"
#include "mesh/plane_graph.hpp"
#include "mesh/surface.hpp"
#include "overlap/around_stretch.hpp"
#include "overlap/meeting_nodes.hpp"

namespace satcheck {

// The faces into which another surface cuts a triangle, from the names of the nodes on them (mesh/plane_graph.hpp).
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
  std::optional<std::uint32_t> face_at(const ExactPoint& p) const;

 private:
  std::uint32_t name_of(std::uint32_t face) const {
    return face == outside_ ? kOutside : face < outside_ ? face : face - 1;
  }

  PlaneGraph graph_;
  std::uint32_t outside_ = 0;           // the face of the graph around the triangle
  std::vector<std::uint32_t> names_;    // of each node of the graph that of MeetingNodes
  std::vector<std::uint32_t> corners_;  // of the triangle: nodes of the graph
};

struct CellFace {
  int mesh;  // 0: a, 1: b
  std::uint32_t triangle;
  std::uint32_t within;  // which one of the triangle's faces
  bool shared = false;   // a face of the other surface coincides with it
};

// Two sides that face each other at a stretch, and the numbers of its ends (meeting_nodes.hpp).
struct Wedge {
  std::uint32_t side, other;
  std::uint32_t low, high;
};

class SpaceCells {
 public:
  // For surfaces without collinear triangles, see without_slivers(). complete() is false if more than `max_pairs` pairs
  // of triangles meet, or if a surface meets itself at the other one. Throws BudgetSpent.
  SpaceCells(const Surface& a, const Surface& b, std::size_t max_pairs, Budget* budget);

  bool complete() const { return complete_; }
  bool within_limits() const { return within_limits_; }
  Budget* budget() const { return budget_; }
  const Surface& surface(int mesh) const { return mesh == 0 ? a_ : b_; }
  const MeetingNodes& nodes() const { return nodes_; }
  const std::vector<CellFace>& faces() const { return faces_; }
  const std::vector<Wedge>& wedges() const { return wedges_; }
  std::uint32_t shell(std::uint32_t side) { return shells_.find(side); }
  // Whether a triangle meets the other surface.
  bool in_contact(int mesh, std::uint32_t triangle) const { return cut_[mesh][triangle] != kNotCut; }
  bool bounds_nothing(const CellFace& face) const;

  // A point inside the face; and the face of a triangle that contains a point.
  ExactPoint sample(std::uint32_t face) const;
  std::optional<std::uint32_t> face_at(int mesh, std::uint32_t triangle, const ExactPoint& p) const;
  // The corners of the face and the box around them, rounded; and its area times its unit normal, in coordinates
  // relative to an origin.
  std::vector<Vec3> face_corners(std::uint32_t face) const;
  Aabb box(std::uint32_t face) const;
  Vec3 area(std::uint32_t face, Vec3 origin) const;

 private:
  static constexpr std::uint32_t kNotCut = 0xFFFFFFFF;

  // Calls visit(from, to) for the stretches around a face, which is on their left; rounded ends.
  template <class Visit>
  void visit_outline(std::uint32_t face, Visit visit) const;
  void meet(std::size_t max_pairs);
  void cut(int mesh);
  std::uint32_t cut_triangle(int mesh, std::uint32_t triangle);
  std::vector<NodePair> segments_in(int mesh, std::uint32_t triangle) const;
  void join_at_edges(int mesh);
  void join_at_stretches();
  void join(std::uint32_t side, std::uint32_t other, std::uint32_t low, std::uint32_t high);
  void unite_shared(const std::vector<HalfPlane>& half_planes);

  const Surface &a_, &b_;
  Budget* budget_;
  MeetingNodes nodes_;
  std::vector<std::pair<std::uint32_t, NodePair>> segments_[2];  // by triangle
  std::vector<std::uint32_t> cut_[2];                            // of each triangle: which of the cuts_, or kNotCut
  std::vector<std::uint32_t> first_face_[2];                     // of each triangle
  std::deque<TriangleFaces> cuts_;
  std::vector<CellFace> faces_;
  std::vector<HalfPlane> half_planes_;
  std::vector<Wedge> wedges_;
  DisjointSets shells_{0};
  bool complete_ = true, within_limits_ = true;
};

}  // namespace satcheck
