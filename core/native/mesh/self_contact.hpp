// Contacts of a surface with itself.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "exact/predicates.hpp"
#include "mesh/plane_cells.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

// A triangle that is compared with others of its mesh.
class MeshTriangle {
 public:
  MeshTriangle(const Mesh& mesh, std::uint32_t t, Budget* budget);

  // Whether they have more in common than shared corners and edges.
  bool has_more_in_common_with(std::uint32_t other) const;

 private:
  Vec3 at(std::uint32_t v) const { return mesh_->vertices[v]; }
  int turn(Vec3 p, Vec3 q, Vec3 r) const;
  bool folds_onto(Vec3 p, Vec3 q, Vec3 r, Vec3 s) const;
  bool goes_on_from(Vec3 p, Vec3 q, Vec3 r, Vec3 s, Vec3 t) const;
  bool parts(Vec3 p, Vec3 q, Vec3 r, Vec3 s, Vec3 t) const;
  bool lies_beyond(const std::array<Vec3, 3>& other) const;

  const Mesh* mesh_;
  Budget* budget_;
  Triangle t_;
  std::array<Vec3, 3> c_;
  TrianglePlane plane_;
  int axis_, turn_;
};

// Whether another triangle of the surface has more in common with t than shared corners and edges. Collinear triangles
// bound nothing and are left out.
bool has_irregular_partners(const Surface& surface, std::uint32_t t, Budget* budget = nullptr);

// Visits the triangles of a surface that wanted(t) accepts until a call returns false: plain(t) one triangle of each
// set of neighbours that have the same winding numbers everywhere, patch(cells) where the surface meets itself.
// surfaces: the surface, and perhaps another one that also cuts the patches.
void visit_uniform_parts(const std::vector<const Surface*>& surfaces, const std::function<bool(std::uint32_t)>& wanted,
                         const std::function<bool(std::uint32_t)>& plain,
                         const std::function<bool(const PlaneCells&)>& patch, Budget* budget = nullptr);

}  // namespace satcheck
