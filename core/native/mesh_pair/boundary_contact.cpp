// A triangle that meets no other triangle of its own mesh is either all boundary or none. One sample decides.
//
// Other triangles are boundary in some of the pieces into which both meshes cut them. The common part of the boundaries
// in the triangles t of A and u of B is closed. It consists of corners, stretches and pieces, which are the same in t
// and u because both meshes cut the pieces. If the common part is not empty, it therefore contains a corner of a
// boundary piece of t that is also a corner of a boundary piece of a triangle of B.
#include "mesh_pair/boundary_contact.hpp"

#include <algorithm>
#include <map>

#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/cuts.hpp"
#include "mesh/self_contact.hpp"

namespace satcheck {
namespace {

bool is_collinear(const Corners& c) { return collinear(c[0], c[1], c[2]); }

class Boundary {
 public:
  Boundary(const Surface& surface, Budget* budget) : surface_(surface), budget_(budget) {}

  // Whether the whole triangle is boundary.
  bool is_plain(std::uint32_t t) {
    const auto [entry, is_new] = plain_.try_emplace(t, false);
    if (is_new) entry->second = is_plain_boundary(surface_, t, budget_);
    return entry->second;
  }

  // Whether a point of the mesh is in the closure of a boundary piece.
  bool contains(const ExactPoint& x) const {
    const auto here = triangles_at(surface_.mesh, surface_.bvh, x, {}, budget_);
    return std::any_of(here.begin(), here.end(), [&](std::uint32_t t) { return reaches(t, x); });
  }

 private:
  // Whether a boundary piece of triangle t ends at its point x.
  bool reaches(std::uint32_t t, const ExactPoint& x) const {
    const Corners c = corners(surface_.mesh, t);
    const auto partners = irregular_partners(surface_, t, budget_);
    auto cuts = find_cuts(surface_.mesh, t, surface_.mesh, partners, Touching::kept, budget_);
    const ExactPoint corner = make_exact_point(c[0]);
    cuts.push_back({corner == x ? make_exact_point(c[1]) : corner, x});
    return !visit_pieces(c, cuts, Touching::kept, [&](const Piece& piece) {
      const auto ends = piece.ends();
      if (std::find(ends.begin(), ends.end(), x) == ends.end()) return true;
      bool boundary = false;
      sample_piece(piece, partners.size(), [&](const ExactPoint& p) {
        const auto sides = beside(surface_, p, c, budget_);
        boundary = sides && sides->is_boundary();
        return sides.has_value();
      });
      return !boundary;
    }, budget_);
  }

  const Surface& surface_;
  Budget* budget_;
  std::map<std::uint32_t, bool> plain_;
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
    samples.note_contact({c.a, c.b, contact_point(corners(a.mesh, c.a), corners(b.mesh, c.b))});
    return;
  }
}

void find_any_contact(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts,
                      Samples& samples, Budget* budget) {
  const Boundary of_b(b, budget);
  std::map<std::uint32_t, std::vector<std::uint32_t>> partners_of;
  for (const ContactPair& c : contacts) partners_of[c.a].push_back(c.b);
  for (const auto& entry : partners_of) {  // a lambda may not capture the names of a structured binding in older Clang
    const std::uint32_t t = entry.first;
    const std::vector<std::uint32_t>& partners = entry.second;
    const Corners c = corners(a.mesh, t);
    if (is_collinear(c)) continue;
    const auto own = irregular_partners(a, t, budget);
    auto cuts = find_cuts(a.mesh, t, b.mesh, partners, Touching::kept, budget);
    const auto own_cuts = find_cuts(a.mesh, t, a.mesh, own, Touching::kept, budget);
    cuts.insert(cuts.end(), own_cuts.begin(), own_cuts.end());
    const bool none = visit_pieces(c, cuts, Touching::kept, [&](const Piece& piece) {
      bool boundary = false;
      const bool known = sample_piece(piece, own.size() + partners.size(), [&](const ExactPoint& p) {
        const auto sides = beside(a, p, c, budget);
        boundary = sides && sides->is_boundary();
        return sides.has_value();
      });
      if (!known) samples.fail();
      if (!boundary) return true;
      for (const ExactPoint& end : piece.ends()) {
        if (!of_b.contains(end)) continue;
        samples.note_contact({t, partners[0], end.rounded});
        return false;
      }
      return true;
    }, budget);
    if (!none) return;
  }
}

}  // namespace satcheck
