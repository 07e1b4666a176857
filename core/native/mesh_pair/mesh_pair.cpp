#include "mesh_pair/mesh_pair.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "exact/triangle_pair.hpp"
#include "mesh_pair/contact.hpp"
#include "mesh_pair/open_surfaces.hpp"
#include "mesh_pair/outline_pair.hpp"
#include "mesh_pair/traversal.hpp"

namespace satcheck {
namespace {

// The most steps of a pair, three to four seconds, and of each triangle in addition. Triangles that meet in an orderly way
// take a few thousand.
constexpr std::uint64_t kPairWork = 3'500'000'000, kWorkOfTriangle = 100'000;
// Of these a question of a search may take one part in so many.
constexpr std::uint64_t kShareInSearch = 8;

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
  if (a.mesh.triangles == b.mesh.triangles && a.mesh.vertices == b.mesh.vertices) return true;
  return canonical_triangles(a.mesh, a.solid) == canonical_triangles(b.mesh, b.solid);
}

MeshRelation make_relation(Relation relation, const std::optional<Evidence>& where) {
  MeshRelation result;
  result.relation = relation;
  if (where) {
    result.triangle_a = where->triangle_a;
    result.triangle_b = where->triangle_b;
    result.point = where->point;
  }
  return result;
}

MeshRelation make_relation(const PairFacts& facts) {
  MeshRelation result = make_relation(facts.relation(), facts.common ? facts.overlap : facts.touch);
  result.proven = facts.proven || facts.settled();
  return result;
}

MeshRelation crossing_relation(const Surface& a, const Surface& b, ContactPair crossing) {
  const Vec3 point = crossing_point(corners(a.mesh, crossing.a), corners(b.mesh, crossing.b));
  return make_relation(Relation::penetrating, Evidence{crossing.a, crossing.b, point});
}

MeshRelation touching_first(const Surface& a, const Surface& b, const SurfaceContacts& contacts) {
  const auto [ta, tb] = contacts.first();
  return make_relation(Relation::touching, Evidence{ta, tb, contact_point(corners(a.mesh, ta), corners(b.mesh, tb))});
}

MeshRelation judged_relation(const Surface& a, const Surface& b, const SurfaceContacts& contacts, Wanted wanted,
                             Budget* budget) {
  MeshRelation result = make_relation(judge_contact(a, b, contacts, wanted, budget));
  if (result.relation == Relation::separated && contacts.any()) {
    // Triangles without area bound no volume, but they are part of the surface.
    result = touching_first(a, b, contacts);
  }
  result.judged = contacts.contacts.size();
  for (const auto& region : contacts.common) result.judged += region.size();
  return result;
}

std::optional<MeshRelation> simple_relation_of(const Surface& a, const Surface& b, const SurfaceContacts& contacts,
                                               Budget* budget) {
  if (contacts.crossing) {
    if (!facts_at_crossing(a, b, *contacts.crossing, budget).settled()) return std::nullopt;
    return crossing_relation(a, b, *contacts.crossing);
  }
  if (contacts.any()) return std::nullopt;
  return judged_relation(a, b, {}, Wanted::relation, budget);
}

bool overlaps(const MeshRelation& r) {
  return r.relation != Relation::separated && r.relation != Relation::touching;
}

MeshRelation relation_of_closed(const Surface& a, const Surface& b, const SurfaceContacts& contacts, Wanted wanted,
                                Budget* budget) {
  if (const auto simple = simple_relation_of(a, b, contacts, budget)) return *simple;
  if (!contacts.crossing) return judged_relation(a, b, contacts, wanted, budget);
  const SurfaceContacts all = find_contacts(a, b, AtCrossing::go_on, budget, kManyContacts);
  const MeshRelation judged = judged_relation(a, b, all, wanted, budget);
  // Each triangle bounds material, is within it, or is a sheet. If two triangles cross, the bodies overlap, even if
  // samples do not show it.
  return overlaps(judged) ? judged : crossing_relation(a, b, *contacts.crossing);
}

// The relation of two closed surfaces, for any triangles.
MeshRelation relation_of_points(const Surface& a, const Surface& b, Wanted wanted, Budget* budget) {
  return relation_of_closed(a, b, find_contacts(a, b, AtCrossing::stop, budget, kManyContacts), wanted, budget);
}

// Whether boundaries cross here, and not internal walls of a body.
bool crosses_boundaries(const ClosedPair& pair, ContactPair crossing, Budget* budget) {
  return facts_at_crossing(pair.a(), pair.b(), crossing, budget).settled();
}

// If surfaces cross, the bodies overlap for every fill. Else the closed surfaces decide, unless the answer depends on
// the fill of a hole. No fill removes an overlap of the open surfaces as sheets that is one of the filled surfaces, too.
MeshRelation relation_of_open(const Surface& a, const Surface& b, const SurfaceContacts& contacts, Wanted wanted,
                              Budget* budget) {
  if (contacts.crossing && wanted == Wanted::overlap) return crossing_relation(a, b, *contacts.crossing);
  const ClosedPair filled(a, b, OpenParts::filled, budget);
  if (contacts.crossing && crosses_boundaries(filled, *contacts.crossing, budget)) {
    return crossing_relation(a, b, *contacts.crossing);
  }
  const Holes holes = holes_between(filled, budget);
  MeshRelation result;
  if (holes.in_the_way) {
    const ClosedPair sheets(a, b, OpenParts::sheets, budget);
    result = relation_of_points(sheets.a(), sheets.b(), wanted, budget);
    if (overlaps(result)) {
      const MeshRelation fill = relation_of_points(filled.a(), filled.b(), wanted, budget);
      if (!overlaps(fill)) result = fill;
    }
    if (!overlaps(result)) result.hole = holes.in_the_way;
  } else {
    result = relation_of_points(filled.a(), filled.b(), wanted, budget);
    const bool by_the_surfaces = result.relation == Relation::touching && contacts.any();
    if (!overlaps(result) && !by_the_surfaces) result.hole = holes.touched;
  }
  result.proven = result.proven && !result.hole;
  if (result.triangle_a >= a.mesh.triangles.size()) result.triangle_a = kNoIndex;
  if (result.triangle_b >= b.mesh.triangles.size()) result.triangle_b = kNoIndex;
  return result;
}

MeshRelation with_counts(MeshRelation result, const SurfaceContacts& contacts) {
  result.box_tests = contacts.box_tests;
  result.triangle_tests = contacts.triangle_tests;
  return result;
}

bool boxes_only_touch(const Surface& a, const Surface& b) {
  if (a.bvh.nodes.empty() || b.bvh.nodes.empty()) return false;
  const Aabb &p = a.bvh.nodes[0].box, &q = b.bvh.nodes[0].box;
  return p.min.x >= q.max.x || q.min.x >= p.max.x || p.min.y >= q.max.y || q.min.y >= p.max.y || p.min.z >= q.max.z ||
         q.min.z >= p.max.z;
}

MeshRelation relation_in_order(const Surface& a, const Surface& b, Wanted wanted, Budget* budget) {
  if (same_geometry(a, b)) {
    const Vec3 point = a.mesh.vertices[a.mesh.triangles[0][0]];
    return make_relation(Relation::coincident, Evidence{0, kNoIndex, point});
  }
  if (const auto in_plane = prism_relation(a, b)) return *in_plane;
  const bool closed = a.solid && b.solid, apart = closed && boxes_only_touch(a, b);
  if (apart && wanted == Wanted::overlap) return make_relation(Relation::separated, {});
  const SurfaceContacts contacts = find_contacts(a, b, apart ? AtCrossing::stop_at_many : AtCrossing::stop, budget, kManyContacts);
  // Solids whose boxes are apart have no common interior. Two flush fans of slivers meet in millions of pairs.
  if (apart && contacts.contacts.size() > kManyContacts) return with_counts(touching_first(a, b, contacts), contacts);
  const auto relation_of = closed ? relation_of_closed : relation_of_open;
  return with_counts(relation_of(a, b, contacts, wanted, budget), contacts);
}

std::optional<MeshRelation> simple_relation_in_order(const Surface& a, const Surface& b, Budget* budget) {
  const SurfaceContacts contacts = find_contacts(a, b, AtCrossing::stop, budget);
  const auto result = simple_relation_of(a, b, contacts, budget);
  return result ? std::optional(with_counts(*result, contacts)) : std::nullopt;
}

// The relation with A and B exchanged.
MeshRelation mirrored(MeshRelation r) {
  std::swap(r.triangle_a, r.triangle_b);
  if (r.hole) r.hole->of_a = !r.hole->of_a;
  if (r.relation == Relation::contains || r.relation == Relation::inside) {
    r.relation = r.relation == Relation::contains ? Relation::inside : Relation::contains;
  }
  return r;
}

MeshRelation relation_of(const Surface& a, const Surface& b, Wanted wanted, Budget& budget) {
  return comes_before(a, b) ? relation_in_order(a, b, wanted, &budget) : mirrored(relation_in_order(b, a, wanted, &budget));
}

MeshRelation undecided() {
  MeshRelation result = make_relation(Relation::penetrating, {});
  result.proven = result.decided = false;
  return result;
}

// What `ask` returns, unless the budget is spent.
template <class Ask>
std::invoke_result_t<Ask> within_budget(Ask ask) {
  try {
    return ask();
  } catch (const BudgetSpent&) {
    return undecided();
  }
}

}  // namespace

Budget budget_of_pair(const Mesh& a, const Mesh& b, Poll poll, std::uint64_t most) {
  const std::uint64_t triangles = a.triangles.size() + b.triangles.size();
  return Budget::that_stops(std::min({kPairWork + kWorkOfTriangle * triangles, kMostSteps, most}), std::move(poll));
}

Budget budget_in_search(const Mesh& a, const Mesh& b, Poll poll) {
  return Budget::that_stops(budget_of_pair(a, b, {}).left() / kShareInSearch, std::move(poll));
}

MeshRelation mesh_relation(const Surface& a, const Surface& b, Budget& budget) {
  const std::uint64_t before = budget.spent();
  MeshRelation result = within_budget([&] { return relation_of(a, b, Wanted::relation, budget); });
  result.steps = budget.spent() - before;
  return result;
}

MeshRelation mesh_relation(const Surface& a, const Surface& b, const Poll& poll, std::uint64_t most) {
  Budget budget = budget_of_pair(a.mesh, b.mesh, poll, most);
  return mesh_relation(a, b, budget);
}

MeshRelation overlap_relation(const Surface& a, const Surface& b, Budget* budget) {
  const Poll poll = [&](const SearchState& state) {
    if (budget != nullptr) budget->tell_again(state.work);
  };
  Budget steps = budget_in_search(a.mesh, b.mesh, poll);
  const MeshRelation result = within_budget([&] { return relation_of(a, b, Wanted::overlap, steps); });
  spend(budget, steps.spent());
  return result;
}

MeshRelation closed_relation(const Surface& a, const Surface& b, Budget* budget) {
  return relation_of_points(a, b, Wanted::relation, budget);
}

std::optional<MeshRelation> simple_relation(const Surface& a, const Surface& b, Budget& budget) {
  return within_budget([&] {
    if (comes_before(a, b)) return simple_relation_in_order(a, b, &budget);
    const auto relation = simple_relation_in_order(b, a, &budget);
    return relation ? std::optional(mirrored(*relation)) : std::nullopt;
  });
}

}  // namespace satcheck
