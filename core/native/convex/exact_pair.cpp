// Three things prove an overlap: a vertex of one hull inside the other one, common vertices that span a solid, and two
// triangles of the surfaces that cross, because a plane that separates the hulls weakly would contain both. If the
// surfaces have no common point, the hulls are apart or nested. Otherwise the origin lies in A - B. It lies on the
// boundary exactly if a facet that contains it separates weakly. Such a facet is a face of A, a face of -B, or spanned by
// two edges that meet, one of each. This is a finite number of signs of determinants of coordinate differences. Float64
// support values leave only axes within `slack` of separating to be tested.

#include "convex/exact_pair.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/rounding.hpp"
#include "convex/separating_face.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"

namespace satcheck {

namespace {

struct Hull {
  Polytope polytope;
  std::vector<Vec3> relative;  // vertices minus the common centre, for the float64 filter only
  double extent = 0;

  Hull(Polytope hull, Vec3 centre) : polytope(std::move(hull)) {
    for (Vec3 p : polytope.vertices) {
      relative.push_back(p - centre);
      extent = std::fmax(extent, max_abs(relative.back()));
    }
  }
};

// A unit axis in float64, and its largest error in radians.
struct RoundedAxis {
  Vec3 unit;
  double error = INFINITY;
};

RoundedAxis axis_across(Vec3 u, Vec3 v) {
  const Vec3 n = cross(u, v);
  const double length = norm(n);
  // Each component of the product has 3 roundings of terms up to |u| |v|. The inputs are differences of coordinates
  // with one more rounding each. Times sqrt(3) for the vector: below 12.
  const double error = 12 * kUnitRoundoff * norm(u) * norm(v) / length;
  if (!(error < kTrustedAxis)) return {};
  return {n * (1 / length), error};
}

// Whether `other` lies completely on or above the plane of a face of `owner`. `owner` lies on or below it.
bool face_separates(const Polytope& owner, const Triangle& t, const Polytope& other) {
  return std::all_of(other.vertices.begin(), other.vertices.end(), [&](Vec3 p) {
    return orientation(owner.vertices[t[0]], owner.vertices[t[1]], owner.vertices[t[2]], p) >= 0;
  });
}

struct Segment {
  Vec3 tail, head;
};

struct Range {
  int min = 1, max = -1;
};

// The range of signs of p's vertices relative to the plane through ea parallel to eb.
Range sides_of(const Polytope& p, Segment ea, Segment eb) {
  Range range;
  for (Vec3 v : p.vertices) {
    const int side = determinant_sign(ea.tail, ea.head, eb.tail, eb.head, ea.tail, v);
    range = {std::min(range.min, side), std::max(range.max, side)};
    if (range.min < 0 && range.max > 0) break;
  }
  return range;
}

// Whether A and B lie on different sides of the plane through A's edge that is parallel to B's edge.
bool edges_separate(const Polytope& a, Segment ea, const Polytope& b, Segment eb) {
  const Range ra = sides_of(a, ea, eb);
  if (ra.min < 0 && ra.max > 0) return false;
  const Range rb = sides_of(b, ea, eb);
  if (ra.min == 0 && ra.max == 0 && rb.min == 0 && rb.max == 0) return false;  // parallel edges: no axis
  return (ra.max <= 0 && rb.min >= 0) || (ra.min >= 0 && rb.max <= 0);
}

std::vector<Segment> edges_of(const Polytope& p) {
  std::vector<Segment> edges;
  if (p.dimension == 1) edges.push_back({p.vertices[0], p.vertices[1]});
  for (const PolytopeEdge& e : p.edges) edges.push_back({p.vertices[e.tail], p.vertices[e.head]});
  return edges;
}

std::vector<Triangle> triangles_of(const Polytope& p) {
  if (p.dimension == 0) return {{0, 0, 0}};
  if (p.dimension == 1) return {{0, 1, 1}};
  return p.triangles;
}

template <class Points>
Aabb bounds_of(const Points& points) {
  Aabb box;
  for (Vec3 p : points) box.include(p);
  return box;
}

// Whether a vertex of p lies strictly inside of q. The face that refuted the last vertex is tried first, because it
// refutes most of them.
bool some_vertex_inside(const Polytope& p, const Polytope& q) {
  if (q.dimension < 3) return false;
  std::vector<TrianglePlane> planes;
  for (std::size_t f = 0; f < q.face_count(); ++f) {
    const Triangle t = corners_of(q, f);
    planes.emplace_back(q.vertices[t[0]], q.vertices[t[1]], q.vertices[t[2]]);
  }
  std::size_t first = 0;
  return std::any_of(p.vertices.begin(), p.vertices.end(), [&](Vec3 v) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const std::size_t f = (first + i) % planes.size();
      if (planes[f].side(v) < 0) continue;
      first = f;
      return false;
    }
    return true;
  });
}

std::vector<Vec3> common_vertices(const Polytope& a, const Polytope& b) {
  std::vector<Vec3> of_a = a.vertices, of_b = b.vertices, common;
  std::sort(of_a.begin(), of_a.end(), coordinates_less);
  std::sort(of_b.begin(), of_b.end(), coordinates_less);
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common), coordinates_less);
  return common;
}

// Whether four of the points, which are all different, are not in a plane.
bool span_solid(const std::vector<Vec3>& points) {
  if (points.size() < 4) return false;
  const Vec3 p = points[0], q = points[1];
  const auto r = std::find_if(points.begin(), points.end(), [&](Vec3 v) { return !collinear(p, q, v); });
  return r != points.end() && std::any_of(r, points.end(), [&](Vec3 v) { return orientation(p, q, *r, v) != 0; });
}

class ExactPair {
 public:
  ExactPair(Polytope a, Polytope b, double slack)
      : origin_(a.vertices.front()),
        a_(std::move(a), origin_),
        b_(std::move(b), origin_),
        bounds_a_(bounds_of(a_.polytope.vertices)),
        bounds_b_(bounds_of(b_.polytope.vertices)),
        slack_(slack) {}

  Outcome decide() const {
    const Polytope &a = a_.polytope, &b = b_.polytope;
    if (some_vertex_inside(a, b) || some_vertex_inside(b, a) || span_solid(common_vertices(a, b))) return Outcome::penetrating;
    switch (first_contact()) {
      case TriangleContact::disjoint:
        return holds(a, b.vertices[0]) || holds(b, a.vertices[0]) ? Outcome::penetrating : Outcome::separated;
      case TriangleContact::crossing:
        return Outcome::penetrating;
      case TriangleContact::touching:
        break;
    }
    // Two flat hulls whose dimensions add up to less than three span no volume.
    if (a.dimension + b.dimension < 3) return Outcome::touching;
    const bool weakly = some_face_separates(a_, b_, 1) || some_face_separates(b_, a_, -1) || some_edges_separate();
    return weakly ? Outcome::touching : Outcome::penetrating;
  }

 private:
  TriangleContact first_contact() const {
    const std::vector<Corners> near_a = triangles_near(a_.polytope, bounds_b_);
    const std::vector<Corners> near_b = triangles_near(b_.polytope, bounds_a_);
    for (const Corners& s : near_a) {
      const Aabb box = bounds_of(s);
      for (const Corners& t : near_b) {
        if (!meet(box, bounds_of(t))) continue;
        const TriangleContact contact = classify(s, t);
        if (contact != TriangleContact::disjoint) return contact;
      }
    }
    return TriangleContact::disjoint;
  }

  static std::vector<Corners> triangles_near(const Polytope& p, const Aabb& box) {
    std::vector<Corners> near;
    for (const Triangle& t : triangles_of(p)) {
      const Corners corners{p.vertices[t[0]], p.vertices[t[1]], p.vertices[t[2]]};
      if (meet(bounds_of(corners), box)) near.push_back(corners);
    }
    return near;
  }

  static std::vector<Segment> edges_near(const Polytope& p, const Aabb& box) {
    std::vector<Segment> edges = edges_of(p);
    std::erase_if(edges, [&](const Segment& e) { return !meet(bounds_of(std::array{e.tail, e.head}), box); });
    return edges;
  }

  static bool holds(const Polytope& p, Vec3 point) {
    if (p.dimension < 3) return false;
    return std::all_of(p.triangles.begin(), p.triangles.end(), [&](const Triangle& t) {
      return orientation(p.vertices[t[0]], p.vertices[t[1]], p.vertices[t[2]], point) <= 0;
    });
  }

  // Whether this axis may separate, even weakly, given its error. Vertices that refuted the last axis are tried first,
  // because they refute most axes at once.
  bool worth_testing(const RoundedAxis& axis, Vec3 sign_unit) const {
    const double allowed = slack_ + axis.error * 2 * (a_.extent + b_.extent);
    const auto lies_beyond = [&](std::size_t i, std::size_t j) {
      return dot(sign_unit, a_.relative[i] - b_.relative[j]) > allowed;
    };
    if (lies_beyond(last_a_, last_b_)) return false;
    for (std::size_t i = 0; i < a_.relative.size(); ++i) {
      if (lies_beyond(i, last_b_)) {
        last_a_ = i;
        return false;
      }
    }
    for (std::size_t i = 0; i < a_.relative.size(); ++i) {
      if (dot(sign_unit, a_.relative[i] - a_.relative[last_a_]) > 0) last_a_ = i;
    }
    for (std::size_t j = 0; j < b_.relative.size(); ++j) {
      if (lies_beyond(last_a_, j)) {
        last_b_ = j;
        return false;
      }
    }
    return true;
  }

  bool some_face_separates(const Hull& owner, const Hull& other, double sign) const {
    const Vec3* v = owner.polytope.vertices.data();
    for (std::size_t f = 0; f < owner.polytope.face_count(); ++f) {
      const Triangle t = corners_of(owner.polytope, f);
      const RoundedAxis axis = axis_across(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]);
      if (std::isfinite(axis.error) && !worth_testing(axis, axis.unit * sign)) continue;
      if (face_separates(owner.polytope, t, other.polytope)) return true;
    }
    return false;
  }

  bool some_edges_separate() const {
    const std::vector<Segment> edges_b = edges_near(b_.polytope, bounds_a_);
    for (const Segment& ea : edges_near(a_.polytope, bounds_b_)) {
      const Aabb box = bounds_of(std::array{ea.tail, ea.head});
      for (const Segment& eb : edges_b) {
        if (!meet(box, bounds_of(std::array{eb.tail, eb.head}))) continue;
        const RoundedAxis axis = axis_across(ea.head - ea.tail, eb.head - eb.tail);
        const bool trusted = std::isfinite(axis.error);
        if (trusted && !worth_testing(axis, axis.unit) && !worth_testing(axis, -axis.unit)) continue;
        if (edges_separate(a_.polytope, ea, b_.polytope, eb)) return true;
      }
    }
    return false;
  }

  Vec3 origin_;
  Hull a_, b_;
  Aabb bounds_a_, bounds_b_;
  double slack_;
  mutable std::size_t last_a_ = 0, last_b_ = 0;
};

}  // namespace

Outcome decide_exactly(Polytope a, Polytope b, double slack) {
  return ExactPair(std::move(a), std::move(b), slack).decide();
}

}  // namespace satcheck
