#include "mesh_pair.hpp"

#include <algorithm>
#include <vector>

#include "contact.hpp"
#include "sheet_contact.hpp"
#include "traversal.hpp"
#include "triangle_pair.hpp"

namespace satcheck {
namespace {

// The first part of `inner` inside `solid`, and whether all are. There is no contact.
struct Containment {
  bool any = false, all = false;
  std::uint32_t triangle = kNoTriangle;
  Vec3 point;
};

Containment find_contained(const Surface& solid, const Surface& inner) {
  Containment result;
  if (!solid.solid || inner.parts.empty()) return result;
  result.all = true;
  for (const SurfacePart& part : inner.parts) {
    const Vec3 point = inner.mesh.vertices[inner.mesh.triangles[part.triangle][0]];
    // The winding number exists: without contact no vertex is on the other surface.
    if (winding_number(solid, point).value_or(0) == 0) {
      result.all = false;
    } else if (!result.any) {
      result.any = true;
      result.triangle = part.triangle;
      result.point = point;
    }
  }
  return result;
}

MeshRelation relation_without_contact(const Surface& a, const Surface& b) {
  const Containment b_in_a = find_contained(a, b), a_in_b = find_contained(b, a);
  MeshRelation result;
  if (!b_in_a.any && !a_in_b.any) return result;
  if (b_in_a.any) {
    result.triangle_b = b_in_a.triangle;
    result.point = b_in_a.point;
  } else {
    result.triangle_a = a_in_b.triangle;
    result.point = a_in_b.point;
  }
  const bool nested = b_in_a.any != a_in_b.any && (b_in_a.all || a_in_b.all);
  result.relation = !nested ? Relation::penetrating
                            : (b_in_a.any ? Relation::contains : Relation::inside);
  return result;
}

// The triangles by coordinates, each rotated to start at its least corner.
std::vector<Corners> canonical_triangles(const Mesh& mesh, bool keep_winding) {
  const auto less = [](Vec3 p, Vec3 q) {
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
  };
  std::vector<Corners> triangles;
  triangles.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Corners& c = triangles.emplace_back(corners(mesh, t));
    if (!keep_winding) {
      std::sort(c.begin(), c.end(), less);
    } else {
      std::rotate(c.begin(), std::min_element(c.begin(), c.end(), less), c.end());
    }
  }
  std::sort(triangles.begin(), triangles.end(), [&](const Corners& s, const Corners& t) {
    return std::lexicographical_compare(s.begin(), s.end(), t.begin(), t.end(), less);
  });
  return triangles;
}

bool same_geometry(const Surface& a, const Surface& b) {
  if (a.mesh.triangles.size() != b.mesh.triangles.size() || a.mesh.triangles.empty()) return false;
  if (a.mesh.vertices.size() != b.mesh.vertices.size() || a.solid != b.solid) return false;
  const Aabb &box_a = a.bvh.nodes[0].box, &box_b = b.bvh.nodes[0].box;
  if (!(box_a.min == box_b.min) || !(box_a.max == box_b.max)) return false;
  return canonical_triangles(a.mesh, a.solid) == canonical_triangles(b.mesh, b.solid);
}

}  // namespace

MeshRelation mesh_relation(const Surface& a, const Surface& b) {
  if (same_geometry(a, b)) {
    MeshRelation result;
    result.relation = Relation::coincident;
    result.triangle_a = 0;
    result.point = a.mesh.vertices[a.mesh.triangles[0][0]];
    return result;
  }
  const SurfaceContacts found = find_contacts(a, b);
  MeshRelation result;
  if (found.crossing) {
    result.relation = Relation::penetrating;
    result.triangle_a = found.crossing->a;
    result.triangle_b = found.crossing->b;
    result.point = crossing_point(corners(a.mesh, result.triangle_a), corners(b.mesh, result.triangle_b));
  } else if (found.contacts.empty()) {
    result = relation_without_contact(a, b);
  } else {
    result.relation = Relation::touching;
    result.triangle_a = found.contacts[0].a;
    result.triangle_b = found.contacts[0].b;
    result.point = contact_point(corners(a.mesh, result.triangle_a), corners(b.mesh, result.triangle_b));
    const ContactVerdict verdict = a.solid || b.solid ? judge_contact(a, b, found.contacts)
                                                      : judge_sheet_contact(a, b, found.contacts);
    result.proven = verdict.proven;
    if (verdict.overlap) {
      result.relation = Relation::penetrating;
      result.triangle_a = verdict.overlap->triangle_a;
      result.triangle_b = verdict.overlap->triangle_b;
      result.point = verdict.overlap->point;
    }
  }
  result.box_tests = found.box_tests;
  result.triangle_tests = found.triangle_tests;
  return result;
}

}  // namespace satcheck
