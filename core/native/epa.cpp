// Expanding Polytope Algorithm: G. van den Bergen, "Proximity Queries and Penetration Depth
// Computation on 3D Game Objects" (2001). Deviations:
//
// - Faces are ordered by the *signed* distance of their plane from the origin, so the origin may lie
//   outside, on or inside the first tetrahedron: aligned and concentric shapes need no special case.
// - min over faces <= signed penetration <= support value along any axis. The loop ends when the two
//   meet, or on a negative support value, which is a separating axis.
// - A face counts as visible only beyond rounding noise. When rounding breaks the polytope all the
//   same, the loop says so (`stalled`) and the caller takes another way.

#include "epa.hpp"

#include <algorithm>
#include <cstdint>

#include "tolerances.hpp"

namespace satcheck {

namespace {

struct Face {
  std::uint32_t vertex[3];
  std::uint32_t neighbour[3];  // across the edge vertex[i], vertex[i + 1]
  Vec3 normal;                 // unit, outward
  double distance;             // signed plane distance from the origin, positive when it is inside
  double slenderness_squared;  // (longest edge / twice the area)^2: what its normal's rounding error grows with
  bool alive;
};

struct HorizonEdge {
  std::uint32_t face;  // the hidden face
  int edge;            // its edge on the horizon
};

// Twice the area and the longest edge, squared, of a triangle; `normal` from its two shortest edges,
// whose cross product carries the least rounding error.
struct Triangle3 {
  Vec3 normal;  // not unit
  double area_squared, longest_squared;
};

Triangle3 span(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const double lab = norm_squared(ab), lbc = norm_squared(bc), lca = norm_squared(ca);
  const Vec3 n = lab >= lbc && lab >= lca ? cross(bc, ca) : lbc >= lca ? cross(ca, ab) : cross(ab, bc);
  return {n, norm_squared(n), std::max({lab, lbc, lca})};
}

// Fills in the plane of a face. False when the triangle is thinner than noise.
bool set_plane(Face& face, Vec3 a, Vec3 b, Vec3 c, double scale) {
  const Triangle3 t = span(a, b, c);
  const double thin = kFlat * scale;
  if (!(t.area_squared > thin * thin * t.longest_squared)) return false;
  const double inverse_area = 1 / std::sqrt(t.area_squared);
  face.normal = t.normal * inverse_area;
  face.distance = dot(face.normal, a);
  face.slenderness_squared = t.longest_squared * inverse_area * inverse_area;
  return true;
}

// Buffers of one thread, kept between pairs so that a query allocates nothing.
struct Workspace {
  std::vector<SupportPoint> vertices;
  std::vector<Face> faces;
  std::vector<HorizonEdge> horizon;
  std::vector<std::uint32_t> visible;
  std::vector<std::uint32_t> fan;  // the faces made around the newest vertex

  void clear() {
    vertices.clear();
    faces.clear();
  }
};

class ExpandingPolytope {
 public:
  ExpandingPolytope(const MinkowskiDifference& difference, Workspace& workspace)
      : m_(difference),
        vertices_(workspace.vertices),
        faces_(workspace.faces),
        horizon_(workspace.horizon),
        visible_(workspace.visible),
        fan_(workspace.fan) {
    workspace.clear();
  }

  // False when A - B is flat; `flat_normal` is set then.
  bool start(const Simplex& seed, Vec3& flat_normal);

  std::uint32_t closest_face() const {
    std::uint32_t best = 0;
    double distance = INFINITY;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].alive && faces_[f].distance < distance) {
        distance = faces_[f].distance;
        best = f;
      }
    }
    return best;
  }

  // A lower bound of the signed penetration that grants every face its own rounding error: the
  // vertices carry half a support error each, and the normal turns by the error of the cross product
  // over its length, where the edges' coordinates are rounded to `scale`, not to themselves.
  double least_proven_distance() const {
    const double noise = m_.support_error(), turned = noise * m_.scale;
    double least = INFINITY;
    for (const Face& face : faces_) {
      if (!face.alive) continue;
      const double margin = face.distance - noise - least;
      if (margin > 0 && turned * turned * face.slenderness_squared <= margin * margin) continue;
      least = std::min(least, face.distance - noise - turned * std::sqrt(face.slenderness_squared));
    }
    return least;
  }

  // Adds a point that sees `seed_face`. False when the polytope cannot take it.
  bool expand(const SupportPoint& point, std::uint32_t seed_face);

  const Face& face(std::uint32_t index) const { return faces_[index]; }
  bool contains(const SupportPoint& point) const {
    return std::any_of(vertices_.begin(), vertices_.end(), [&](const SupportPoint& v) { return v.same_as(point); });
  }
  const SupportPoint& vertex(std::uint32_t index) const { return vertices_[index]; }
  bool has_vertex(std::uint32_t f, const SupportPoint& point) const {
    for (std::uint32_t v : faces_[f].vertex) {
      if (vertices_[v].same_as(point)) return true;
    }
    return false;
  }

 private:
  bool complete_tetrahedron(Vec3& flat_normal);
  bool sees(const Face& face, Vec3 point) const { return dot(face.normal, point) - face.distance > kVisible * m_.scale; }
  void collect_horizon(std::uint32_t f, Vec3 point);
  bool fill_face(std::uint32_t slot, std::uint32_t a, std::uint32_t b, std::uint32_t c);

  const MinkowskiDifference& m_;
  std::vector<SupportPoint>& vertices_;
  std::vector<Face>& faces_;  // dead ones are taken again by new faces
  std::vector<HorizonEdge>& horizon_;
  std::vector<std::uint32_t>& visible_;
  std::vector<std::uint32_t>& fan_;
};

bool ExpandingPolytope::complete_tetrahedron(Vec3& flat_normal) {
  const double thin = kFlat * m_.scale;
  const auto offer_farthest = [&](auto&& height, std::initializer_list<Vec3> directions) {
    SupportPoint best{};
    double best_height = -1;
    for (Vec3 direction : directions) {
      const SupportPoint p = m_.support(direction);
      const double h = height(p.w);
      if (h > best_height) {
        best = p;
        best_height = h;
      }
    }
    if (best_height > thin) vertices_.push_back(best);
    return best_height > thin;
  };
  if (vertices_.size() == 1) {
    const Vec3 p = vertices_[0].w;
    if (!offer_farthest([&](Vec3 w) { return norm(w - p); },
                        {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})) {
      flat_normal = norm(p) > 0 ? p * (1 / norm(p)) : Vec3{0, 0, 1};  // a point
      return false;
    }
  }
  if (vertices_.size() == 2) {
    const Vec3 p = vertices_[0].w, e = vertices_[1].w - p, unit = e * (1 / norm(e));
    const Vec3 across = any_perpendicular(unit), third = cross(unit, across);
    if (!offer_farthest([&](Vec3 w) { return norm(cross(unit, w - p)); }, {across, -across, third, -third})) {
      const Vec3 off = p - unit * dot(unit, p);  // a segment: away from the origin, or any way across
      flat_normal = norm(off) > thin ? off * (1 / norm(off)) : across;
      return false;
    }
  }
  const Vec3 p = vertices_[0].w;
  const Vec3 n = cross(vertices_[1].w - p, vertices_[2].w - p);
  const Vec3 unit = n * (1 / norm(n));
  flat_normal = unit;
  return offer_farthest([&](Vec3 w) { return std::fabs(dot(unit, w - p)); }, {unit, -unit});
}

bool ExpandingPolytope::start(const Simplex& seed, Vec3& flat_normal) {
  // Keep the seed's vertices as long as each adds a dimension beyond noise.
  const double thin = kFlat * m_.scale;
  for (int i = 0; i < seed.count; ++i) {
    const Vec3 w = seed.vertex[i].w;
    bool spans = true;
    if (vertices_.size() == 1) spans = norm(w - vertices_[0].w) > thin;
    if (vertices_.size() == 2) {
      const Vec3 e = vertices_[1].w - vertices_[0].w;
      spans = norm(cross(e, w - vertices_[0].w)) > thin * norm(e);
    }
    if (vertices_.size() == 3) {
      const Vec3 n = cross(vertices_[1].w - vertices_[0].w, vertices_[2].w - vertices_[0].w);
      spans = std::fabs(dot(n, w - vertices_[0].w)) > thin * norm(n);
    }
    if (spans) vertices_.push_back(seed.vertex[i]);
  }
  if (vertices_.empty()) vertices_.push_back(m_.support({1, 0, 0}));
  if (vertices_.size() < 4 && !complete_tetrahedron(flat_normal)) return false;
  const Vec3 a = vertices_[0].w;
  if (dot(cross(vertices_[1].w - a, vertices_[2].w - a), vertices_[3].w - a) > 0) std::swap(vertices_[1], vertices_[2]);
  constexpr std::uint32_t corners[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  constexpr std::uint32_t across[4][3] = {{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}};
  for (int f = 0; f < 4; ++f) {
    if (!fill_face(static_cast<std::uint32_t>(f), corners[f][0], corners[f][1], corners[f][2])) return false;
    for (int e = 0; e < 3; ++e) faces_[f].neighbour[e] = across[f][e];
  }
  return true;
}

bool ExpandingPolytope::fill_face(std::uint32_t slot, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (slot == faces_.size()) faces_.emplace_back();
  Face& face = faces_[slot];
  face.vertex[0] = a;
  face.vertex[1] = b;
  face.vertex[2] = c;
  face.alive = true;
  return set_plane(face, vertices_[a].w, vertices_[b].w, vertices_[c].w, m_.scale);
}

void ExpandingPolytope::collect_horizon(std::uint32_t seed_face, Vec3 point) {
  horizon_.clear();
  visible_.assign(1, seed_face);
  faces_[seed_face].alive = false;
  for (std::size_t next = 0; next < visible_.size(); ++next) {
    for (const std::uint32_t g : faces_[visible_[next]].neighbour) {
      if (faces_[g].alive && sees(faces_[g], point)) {
        faces_[g].alive = false;
        visible_.push_back(g);
      }
    }
  }
  for (const std::uint32_t f : visible_) {
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t g = faces_[f].neighbour[e];
      if (!faces_[g].alive) continue;
      const std::uint32_t head = faces_[f].vertex[e], tail = faces_[f].vertex[(e + 1) % 3];
      for (int k = 0; k < 3; ++k) {
        if (faces_[g].vertex[k] == tail && faces_[g].vertex[(k + 1) % 3] == head) horizon_.push_back({g, k});
      }
    }
  }
}

bool ExpandingPolytope::expand(const SupportPoint& point, std::uint32_t seed_face) {
  collect_horizon(seed_face, point.w);
  if (horizon_.size() < 3) return false;
  const std::uint32_t apex = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back(point);
  fan_.clear();
  for (std::size_t i = 0; i < horizon_.size(); ++i) {
    const Face& hidden = faces_[horizon_[i].face];
    const std::uint32_t tail = hidden.vertex[(horizon_[i].edge + 1) % 3], head = hidden.vertex[horizon_[i].edge];
    const std::uint32_t slot = i < visible_.size() ? visible_[i] : static_cast<std::uint32_t>(faces_.size());
    if (!fill_face(slot, tail, head, apex)) return false;
    faces_[slot].neighbour[0] = horizon_[i].face;
    faces_[horizon_[i].face].neighbour[horizon_[i].edge] = slot;
    fan_.push_back(slot);
  }
  for (const std::uint32_t slot : fan_) {
    bool next_found = false;
    for (const std::uint32_t other : fan_) {
      if (faces_[other].vertex[0] != faces_[slot].vertex[1]) continue;
      if (next_found) return false;  // the horizon is not one loop
      faces_[slot].neighbour[1] = other;
      faces_[other].neighbour[2] = slot;
      next_found = true;
    }
    if (!next_found) return false;
  }
  return true;
}

// The facet with the weights of the origin's projection onto its plane, clamped to the facet.
Simplex weighted_facet(const ExpandingPolytope& polytope, const Face& face) {
  const Vec3 foot = face.normal * face.distance;
  Simplex facet;
  for (std::uint32_t v : face.vertex) {
    SupportPoint p = polytope.vertex(v);
    p.w = p.w - foot;
    facet.add(p);
  }
  const ClosestPoint closest = closest_point(facet);
  for (SupportPoint& p : facet.vertex) p.w = p.w + foot;
  keep(facet, closest);
  return facet;
}

}  // namespace

SATCHECK_WIDE EpaResult epa(const MinkowskiDifference& m, const Simplex& seed, EpaGoal goal) {
  EpaResult result;
  thread_local Workspace workspace;
  ExpandingPolytope polytope(m, workspace);
  Vec3 flat_normal;
  if (!polytope.start(seed, flat_normal)) {
    // A support value along the normal of a flat set is its plane's distance from the origin.
    const double towards = dot(flat_normal, m.support(flat_normal).w);
    const double against = dot(-flat_normal, m.support(-flat_normal).w);
    result.status = EpaResult::Status::flat;
    result.axis = towards <= against ? flat_normal : -flat_normal;
    result.upper = std::min(towards, against);
    return result;
  }
  const double noise = m.support_error();
  const double closed = (m.curved ? kCurvedFacetGap : kVisible) * m.scale;
  for (;;) {
    const std::uint32_t f = polytope.closest_face();
    const Face face = polytope.face(f);
    const SupportPoint w = m.support(face.normal);
    const double support = dot(face.normal, w.w);
    ++result.iterations;
    const bool facet_of_difference = support - face.distance <= closed || polytope.has_vertex(f, w);
    if (support < result.upper || facet_of_difference) {
      result.upper = support;
      result.axis = face.normal;
    }
    if (support < -noise) {
      result.status = EpaResult::Status::separated;
      return result;
    }
    if (goal == EpaGoal::sign && face.distance > noise && polytope.least_proven_distance() > noise) {
      result.lower = polytope.least_proven_distance();
      result.status = EpaResult::Status::depth;
      return result;
    }
    if (facet_of_difference) {
      // On curved shapes the last facets are splinters: what was proven before may be more.
      result.lower = std::max(m.curved ? result.lower : -INFINITY, polytope.least_proven_distance());
      result.facet = weighted_facet(polytope, face);
      result.status = EpaResult::Status::depth;
      return result;
    }
    // A vertex that is there already and still outside a face: rounding has bent the polytope, and
    // going on could go on for ever. What was proven so far stands.
    if (m.curved) {
      result.lower = std::max(result.lower, polytope.least_proven_distance());
      result.status = EpaResult::Status::bounded;
      if (result.iterations >= kCurvedExpansions) return result;
    } else {
      result.lower = face.distance - m.support_error();
    }
    if (polytope.contains(w) || !polytope.expand(w, f)) return result;
  }
}

}  // namespace satcheck
