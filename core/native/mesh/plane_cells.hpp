// The cells into which closed surfaces cut a patch of coplanar triangles, with the winding numbers beside each cell.
//
// Just in front of the plane, the winding number of a surface changes only where one of its triangles leaves the plane
// to the front; the direction in which the triangle runs along this segment gives the sign. Behind the plane likewise.
// So one ray gives the winding numbers of all cells of the patch.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/plane_graph.hpp"
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
  // One or two closed surfaces. The patch is the triangle `first`, which is not collinear, with all triangles that are
  // connected with it by common area.
  PlaneCells(std::vector<const Surface*> surfaces, PatchTriangle first, SinglePoints points, Budget* budget);

  const std::vector<PatchTriangle>& members() const { return members_; }

  // The cells in the patch, by number.
  const std::vector<std::uint32_t>& cells() const { return in_patch_; }
  // The winding numbers beside the cell; empty if no ray decides them. The front is that of the first triangle.
  std::optional<Beside> beside(std::uint32_t cell, int surface) const;
  // A point inside the cell; and the triangles of the patch that contain it.
  ExactPoint inside(std::uint32_t cell) const;
  std::vector<PatchTriangle> members_at(const ExactPoint& p) const;

  const LazyPoint& node(std::uint32_t number) const { return graph_.node(number); }
  std::vector<std::uint32_t> nodes_of(std::uint32_t cell) const;
  // The cells in the patch that have a corner at x.
  std::vector<std::uint32_t> cells_at(const LazyPoint& x) const;

 private:
  // coplanar: it may share area with another member.
  enum class Seen : std::uint8_t { coplanar, done };
  struct Sides {
    bool known = false;
    PlaneChanges at{};  // beside the cell
    bool in_patch() const { return at[0].cover > 0 || at[1].cover > 0; }
  };

  Corners corners_of(PatchTriangle t) const { return corners(surfaces_[t.surface]->mesh, t.triangle); }
  static std::uint64_t key(PatchTriangle t) { return std::uint64_t(t.surface) << 32 | t.triangle; }
  void gather();
  void look_at(PatchTriangle other, const Corners& member);
  void add_sides(PatchTriangle coplanar, bool is_member);
  void add_trace(int surface, const Corners& c, const std::array<int, 3>& side);
  void find_windings();
  void start_left_of(std::uint32_t h);
  void spread(std::uint32_t cell);
  bool holds(const Corners& triangle, const ExactPoint& p) const;

  std::vector<const Surface*> surfaces_;
  SinglePoints points_;
  Budget* budget_;
  Corners first_corners_;
  TrianglePlane plane_;
  PlaneGraph graph_;
  std::vector<PatchTriangle> members_;
  std::vector<std::uint32_t> corners_;  // nodes: three of each member
  std::unordered_map<std::uint64_t, Seen> seen_;
  std::vector<Sides> sides_;  // of each face of the graph
  std::vector<std::uint32_t> in_patch_;
  bool decided_ = true;
};

}  // namespace satcheck
