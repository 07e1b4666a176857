// The cells into which closed surfaces cut a patch of coplanar triangles, with the winding numbers beside each cell.
//
// Method: a planar graph, traced by its half-edges (Mark de Berg, Otfried Cheong, Marc van Kreveld, Mark Overmars,
// "Computational Geometry", 3rd ed. 2008, chapter 2). Its nodes have names: a vertex, an edge of a mesh that meets the
// plane, or two segments that cross. Names of one point follow each other on a segment, where they become one node.
//
// Just in front of the plane, the winding number of a surface changes only where one of its triangles leaves the plane
// to the front; the direction in which the triangle runs along this segment gives the sign. Behind the plane likewise.
// So one ray for each connected part of the graph gives the winding numbers of all cells around it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "exact/exact_point.hpp"
#include "exact/ratio.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/surface.hpp"
#include "mesh/winding.hpp"

namespace satcheck {

struct PatchTriangle {
  int surface;  // 0 or 1
  std::uint32_t triangle;
  auto operator<=>(const PatchTriangle&) const = default;
};

// all: every point of the patch that another triangle touches is on an edge of the graph.
enum class SinglePoints : std::uint8_t { left_out, all };

class PlaneCells {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  // One or two closed surfaces. The patch is the triangle `first`, which is not collinear, with all triangles that are
  // connected with it by common area.
  PlaneCells(std::vector<const Surface*> surfaces, PatchTriangle first, SinglePoints points, Budget* budget);
  PlaneCells(const PlaneCells&) = delete;
  PlaneCells& operator=(const PlaneCells&) = delete;

  const std::vector<PatchTriangle>& members() const { return members_; }

  // The outlines of the cells in the patch. A cell has one for each connected part of its boundary.
  const std::vector<std::uint32_t>& outlines() const { return in_patch_; }
  // The same for one triangle of the patch.
  std::vector<std::uint32_t> outlines_in(PatchTriangle member) const;
  // The winding numbers beside the cell; empty if no ray decides them. The front is that of the first triangle.
  std::optional<Beside> beside(std::uint32_t outline, int surface) const;
  // A point inside the cell; and for each surface a triangle of the patch that contains it, or kNone.
  ExactPoint inside(std::uint32_t outline) const;
  std::array<std::uint32_t, 2> triangles_at(const ExactPoint& p) const;

  const LazyPoint& node(std::uint32_t number) const { return nodes_[number]; }
  std::vector<std::uint32_t> nodes_of(std::uint32_t outline) const;
  // The outlines in the patch that pass through the node at x; empty if there is no node.
  std::vector<std::uint32_t> outlines_at(const LazyPoint& x) const;

 private:
  // From the left of a segment to its right: the number of triangles of the patch, and the winding numbers.
  struct Change {
    int cover = 0, front = 0, back = 0;
    bool operator==(const Change&) const = default;
  };
  using Changes = std::array<Change, 2>;  // of each surface
  struct Segment {
    std::uint32_t from, to;
    Changes changes;
    std::vector<std::uint32_t> stops;  // nodes inside it
    std::vector<std::uint32_t> edges;
  };
  struct Edge {
    std::uint32_t low, high;  // nodes
    std::uint32_t segment;
    bool forward;  // the segment runs from low to high
    Changes changes;
  };
  struct Sides {
    bool known = false, decided = true;
    Changes at{};  // beside the cell
    bool in_patch() const { return at[0].cover > 0 || at[1].cover > 0; }
  };

  Corners corners_of(PatchTriangle t) const { return corners(surfaces_[t.surface]->mesh, t.triangle); }
  int side(std::uint32_t p, std::uint32_t q, const LazyPoint& of) const {
    return turn_ * orientation_2d_at(nodes_[p], nodes_[q], of, axis_);
  }

  void gather();
  void look_at(PatchTriangle other, const TrianglePlane& member);
  void add_sides(PatchTriangle coplanar, bool is_member);
  void add_trace(int surface, const Corners& c, const std::array<int, 3>& side);
  std::uint32_t vertex(Vec3 p);
  std::uint32_t piercing(Vec3 p, Vec3 q);
  void add_segment(std::uint32_t from, std::uint32_t to, int surface, Change change);

  void meet_segments();
  void meet(std::uint32_t i, std::uint32_t k);
  void stop_at(std::uint32_t segment, std::uint32_t node);
  int axis_along(const Segment& s) const;
  void cut_segments();

  std::uint32_t start(std::uint32_t h) const { return h % 2 ? edges_[h / 2].high : edges_[h / 2].low; }
  std::uint32_t far_end(std::uint32_t h) const;
  Changes changes(std::uint32_t h) const;
  void trace();
  void sort_around(std::vector<std::uint32_t>& half_edges) const;

  void find_windings();
  void start_at(std::uint32_t h);
  void spread(std::uint32_t outline);
  std::optional<ExactPoint> inside_left_of(std::uint32_t h, int attempt) const;
  Ratio clear_way(const ExactPoint& from, const LazyPoint& lazy_from, std::uint32_t to) const;
  bool holds(const Corners& triangle, const ExactPoint& p) const;

  std::vector<const Surface*> surfaces_;
  SinglePoints points_;
  Budget* budget_;
  Corners plane_corners_;
  TrianglePlane plane_;
  int axis_, turn_;

  std::vector<PatchTriangle> members_;
  std::map<PatchTriangle, bool> seen_;  // whether nothing more is to be learnt of it
  std::vector<LazyPoint> nodes_;
  std::map<std::array<double, 3>, std::uint32_t> vertices_;
  std::map<std::array<double, 6>, std::uint32_t> piercings_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> segment_of_;
  std::vector<Segment> segments_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> same_;  // names of one point
  std::vector<std::uint32_t> part_;                            // of each node: the connected part of the graph
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> next_, outline_;  // of each half-edge
  std::vector<std::uint32_t> first_;           // of each outline: a half-edge
  std::vector<Sides> sides_;                   // of each outline
  std::vector<std::uint32_t> in_patch_;
  bool consistent_ = true;
};

}  // namespace satcheck
