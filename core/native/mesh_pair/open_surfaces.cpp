#include "mesh_pair/open_surfaces.hpp"

#include <cmath>

#include "mesh/bvh.hpp"
#include "mesh_pair/mesh_distance.hpp"

namespace satcheck {
namespace {

enum class Clearness { clear, touched, in_the_way };

// A body apart from the hull does not meet the fill. A body that contains the hull, without touching it, contains
// every fill.
Clearness clearness_of(const MeshRelation& hull_to_body) {
  if (!hull_to_body.proven) return Clearness::in_the_way;
  switch (hull_to_body.relation) {
    case Relation::separated:
    case Relation::inside: return Clearness::clear;
    case Relation::touching: return Clearness::touched;
    default: return Clearness::in_the_way;
  }
}

bool meets_a_triangle(const Aabb& box, const Surface& surface, Budget* budget) {
  if (surface.bvh.nodes.empty()) return false;
  return !visit_box(surface.bvh, surface.mesh, box, [](std::uint32_t) { return false; }, budget);
}

const Aabb& box_of(const Surface& hull) { return hull.bvh.nodes[0].box; }

// The holes of one surface against the other surface.
class HoledSide {
 public:
  HoledSide(const Closing& holed, const Surface& other, const Closing* closing_of_other, bool is_a, Budget* budget)
      : holed_(holed), other_(other), closing_of_other_(closing_of_other), is_a_(is_a), budget_(budget) {}

  void look(Holes& holes) const {
    for (std::size_t k = 0; k < holed_.hulls.size() && !holes.in_the_way; ++k) {
      const Clearness clearness = clearness_at(k);
      if (clearness == Clearness::in_the_way) holes.in_the_way = open_hole(k);
      if (clearness == Clearness::touched && !holes.touched) holes.touched = open_hole(k);
    }
  }

 private:
  Clearness clearness_at(std::size_t k) const {
    const Surface& hull = holed_.hulls[k];
    if (hull.bvh.nodes.empty() || !meets_a_triangle(box_of(hull), other_, budget_)) return Clearness::clear;
    Clearness clearness = clearness_of(closed_relation(hull, other_, budget_));
    if (closing_of_other_ == nullptr) return clearness;
    for (const Surface& theirs : closing_of_other_->hulls) {
      if (clearness == Clearness::in_the_way) break;
      if (theirs.bvh.nodes.empty() || !meet(box_of(theirs), box_of(hull))) continue;
      const MeshRelation relation = closed_relation(hull, theirs, budget_);
      // Within the hull of another hole, the answer is unknown.
      const bool within = relation.relation == Relation::inside;
      clearness = std::max(clearness, within ? Clearness::in_the_way : clearness_of(relation));
    }
    return clearness;
  }

  OpenHole open_hole(std::size_t k) const {
    const Hole& hole = holed_.holes[k];
    return {is_a_, k, holed_.holes.size(), hole.centre(), hole.diameter(), hole.loops.empty()};
  }

  const Closing& holed_;
  const Surface& other_;
  const Closing* closing_of_other_;
  bool is_a_;
  Budget* budget_;
};

}  // namespace

ClosedPair::ClosedPair(const Surface& a, const Surface& b, OpenParts open, Budget* budget) : a_(a), b_(b) {
  if (!a.solid) of_a_ = closing_of(a, open, budget);
  if (!b.solid) of_b_ = closing_of(b, open, budget);
}

Holes holes_between(const ClosedPair& pair, Budget* budget) {
  Holes holes;
  if (pair.closing_a()) HoledSide(*pair.closing_a(), pair.b(), pair.closing_b(), true, budget).look(holes);
  if (pair.closing_b() && !holes.in_the_way) {
    HoledSide(*pair.closing_b(), pair.a(), pair.closing_a(), false, budget).look(holes);
  }
  return holes;
}

std::optional<double> distance_of_holes(const Surface& a, const Surface& b, double limit, Budget* budget) {
  const ClosedPair pair(a, b, OpenParts::filled, budget);
  static const std::vector<Surface> none;
  const auto& hulls_a = pair.closing_a() ? pair.closing_a()->hulls : none;
  const auto& hulls_b = pair.closing_b() ? pair.closing_b()->hulls : none;
  double least = limit;
  const auto look = [&](const Surface& hull, const Surface& other) {
    if (hull.bvh.nodes.empty() || other.bvh.nodes.empty()) return;
    least = std::fmin(least, mesh_distance(hull, other, least, {}, budget).distance);
  };
  for (const Surface& hull : hulls_a) look(hull, b);
  for (const Surface& hull : hulls_b) look(hull, a);
  for (const Surface& hull : hulls_a) {
    for (const Surface& theirs : hulls_b) look(hull, theirs);
  }
  return least < limit ? std::optional(least) : std::nullopt;
}

}  // namespace satcheck
