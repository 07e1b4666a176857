// A triangle that meets no other triangle of its own mesh is either all boundary or none. One sample decides.
//
// Other triangles are boundary in some of the pieces into which both meshes cut them. The common part of the boundaries
// in the triangles t of A and u of B is closed. It consists of corners, stretches and pieces, which are the same in t
// and u because both meshes cut the pieces. If the common part is not empty, it therefore contains a corner of a
// boundary piece of t that is also a corner of a boundary piece of a triangle of B. It is a node in both planes: the
// triangles that name it in the plane of t meet that of u, too, and along different lines.
#include "mesh_pair/boundary_contact.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/plane_cells.hpp"
#include "mesh/self_contact.hpp"

namespace satcheck {
namespace {

class Boundary {
 public:
  Boundary(const Surface& surface, Budget* budget) : surface_(surface), budget_(budget) {}

  // Whether the whole triangle is boundary.
  bool is_plain(std::uint32_t t) {
    const auto [entry, is_new] = plain_.try_emplace(t, false);
    if (is_new) entry->second = is_plain_boundary(surface_, t, budget_);
    return entry->second;
  }

  // Whether x, a node of a patch of A, is a corner of a boundary piece of this surface, B. Empty: not decided. Where a
  // segment that only ties a single point to the patch crosses others, x may be no node in the plane of B.
  std::optional<bool> contains(const LazyPoint& x, const Surface& a) {
    bool decided = true;
    for (const std::uint32_t t : triangles_at(surface_.mesh, surface_.bvh, x, {}, budget_)) {
      if (is_plain(t)) return true;
      if (!has_irregular_partners(surface_, t, budget_)) continue;
      const PlaneCells& cells = cells_of(t, a);
      for (const std::uint32_t cell : cells.cells_at(x)) {
        const auto sides = cells.beside(cell, 1);
        if (sides && sides->is_boundary()) return true;
        decided = decided && sides;
      }
    }
    return decided ? std::optional(false) : std::nullopt;
  }

 private:
  const PlaneCells& cells_of(std::uint32_t t, const Surface& a) {
    if (const auto known = cells_.find(t); known != cells_.end()) return *known->second;
    const std::vector<const Surface*> surfaces{&a, &surface_};
    const auto cells = std::make_shared<const PlaneCells>(surfaces, PatchTriangle{1, t}, SinglePoints::all, budget_);
    for (const PatchTriangle& member : cells->members()) {
      if (member.surface == 1) cells_[member.triangle] = cells;
    }
    return *cells;
  }

  const Surface& surface_;
  Budget* budget_;
  std::map<std::uint32_t, bool> plain_;
  std::map<std::uint32_t, std::shared_ptr<const PlaneCells>> cells_;  // of each triangle
};

}  // namespace

bool is_plain_boundary(const Surface& surface, std::uint32_t t, Budget* budget) {
  const Corners c = corners(surface.mesh, t);
  if (is_collinear(c)) return false;
  if (has_irregular_partners(surface, t, budget)) return false;
  const auto sides = beside_inner(surface, lazy_centroid(c), t, budget);
  return sides && sides->is_boundary();
}

void find_plain_contact(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts,
                        Samples& samples, Budget* budget) {
  Boundary of_a(a, budget), of_b(b, budget);
  for (const ContactPair& c : contacts) {
    if (!of_a.is_plain(c.a) || !of_b.is_plain(c.b)) continue;
    samples.note_contact([&] { return Evidence{c.a, c.b, contact_point(corners(a.mesh, c.a), corners(b.mesh, c.b))}; });
    return;
  }
}

void find_any_contact(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts,
                      Samples& samples, Budget* budget) {
  Boundary of_b(b, budget);
  std::map<std::uint32_t, std::uint32_t> partner_of;
  for (const ContactPair& c : contacts) partner_of.try_emplace(c.a, c.b);
  std::set<std::uint32_t> done;
  for (const auto& [t, partner] : partner_of) {
    if (done.contains(t) || is_collinear(corners(a.mesh, t))) continue;
    const PlaneCells cells({&a, &b}, {0, t}, SinglePoints::all, budget);
    for (const PatchTriangle& member : cells.members()) {
      if (member.surface == 0) done.insert(member.triangle);
    }
    std::set<std::uint32_t> tried;
    for (const std::uint32_t cell : cells.cells()) {
      const auto sides = cells.beside(cell, 0);
      if (!sides) samples.fail();
      if (!sides || !sides->is_boundary()) continue;
      for (const std::uint32_t node : cells.nodes_of(cell)) {
        if (!tried.insert(node).second) continue;
        const auto contains = of_b.contains(cells.node(node), a);
        if (!contains) samples.fail();
        if (!contains.value_or(false)) continue;
        const Evidence where{t, partner, cells.node(node).rounded};
        samples.note_contact([&] { return where; });
        return;
      }
    }
  }
}

}  // namespace satcheck
