// Expanding Polytope Algorithm: G. van den Bergen, "Proximity Queries and Penetration Depth
// Computation on 3D Game Objects" (2001). Deviations:
//
// - Faces are ordered by the *signed* distance of their plane from the origin, so the origin may lie
//   outside, on or inside the first tetrahedron: aligned and concentric shapes need no special case.
// - min over faces <= signed penetration <= support value along any axis. The loop ends when the two
//   meet, or on a negative support value, which is a separating axis.
// - A face counts as visible only beyond rounding noise. When rounding breaks the polytope all the
//   same, the loop says so (`stalled`) and the caller takes another way.

#include "convex/epa.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/tolerances.hpp"

namespace satcheck {

namespace {

// An edge of a face, as one number: 4 times the face and 0, 1 or 2.
using HalfEdge = std::uint32_t;
std::uint32_t face_of(HalfEdge h) { return h / 4; }
std::uint32_t corner_of(HalfEdge h) { return h % 4; }
std::uint32_t after(std::uint32_t corner) { return corner == 2 ? 0 : corner + 1; }

struct Face {
  std::uint32_t vertex[3];
  HalfEdge twin[3];        // the other side of the edge vertex[i], vertex[i + 1]
  Vec3 normal;             // unit, outward
  double stretch_squared;  // (two shortest edges / twice the area)^2: what its normal's rounding error grows with
};

// Buffers of one thread, kept between pairs so that a query allocates nothing.
struct Workspace {
  std::vector<SupportPoint> vertices;
  std::vector<Face> faces;
  // By face: the signed distance of its plane from the origin, positive when it is inside. INFINITY: the
  // face is gone, its place is free. Padded with that for the lanes.
  std::vector<double> distance;
  std::vector<HalfEdge> horizon;       // the hidden sides of the horizon's edges, in the order of the loop
  std::vector<std::uint32_t> visible;  // the faces the newest vertex took away
  std::vector<double> x, y, z;         // the vertices of the horizon, the first one again at the end

  void clear() {
    vertices.clear();
    faces.clear();
    distance.clear();
    horizon.clear();
    visible.clear();
    clear_loop();
  }
  void clear_loop() {
    x.clear();
    y.clear();
    z.clear();
  }
  void add_to_loop(Vec3 p) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  // So that lanes may run over the end.
  void pad_loop() {
    for (int i = 0; i < 4; ++i) add_to_loop({x.back(), y.back(), z.back()});
  }
};

class ExpandingPolytope {
 public:
  ExpandingPolytope(const MinkowskiDifference& difference, Workspace& workspace)
      : m_(difference), vertices_(workspace.vertices), faces_(workspace.faces), distance_(workspace.distance), w_(workspace) {
    workspace.clear();
  }

  // False when A - B is flat; `flat_normal` is set then.
  bool start(const Simplex& seed, Vec3& flat_normal);

  SATCHECK_INLINE std::uint32_t closest_face() const {
    Lanes at = {0, 1, 2, 3};
    LaneBest best = {-load_lanes(distance_.data()), at};
    for (std::size_t f = 4; f < distance_.size(); f += 4) {
      at = at + all_lanes(4);
      const Lanes value = -load_lanes(distance_.data() + f);
      const LaneMask closer = value > best.value;
      best = {select(closer, value, best.value), select(closer, at, best.index)};
    }
    return index_of_largest(best);
  }

  // A lower bound of the signed penetration. A closed surface whose oriented planes all pass the origin by
  // more than r winds around it, and the hull of its vertices holds the ball of radius r, whether rounding
  // has left it convex or not. The vertices are off by a support error at most; a plane is off by the error
  // of a cross product of computed edges, 6 roundoffs times their lengths, over its length, at a lever of
  // sqrt(3) scales. `closest` is looked at first: few others come near it.
  double least_proven_distance(std::uint32_t closest) const {
    const double noise = m_.support_error(), turned = kVisible * m_.scale;
    const auto proven = [&](std::size_t f) { return distance_[f] - noise - turned * std::sqrt(faces_[f].stretch_squared); };
    double least = proven(closest);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const double margin = distance_[f] - noise - least;
      if (margin > 0 && turned * turned * faces_[f].stretch_squared <= margin * margin) continue;
      if (is_alive(static_cast<std::uint32_t>(f))) least = smaller(least, proven(f));
    }
    return least;
  }

  // Adds a point that sees `seed_face`. False when the polytope cannot take it.
  SATCHECK_INLINE bool expand(const SupportPoint& point, std::uint32_t seed_face);

  const Face& face(std::uint32_t index) const { return faces_[index]; }
  double distance(std::uint32_t index) const { return distance_[index]; }
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
  bool is_alive(std::uint32_t f) const { return distance_[f] < INFINITY; }
  bool sees(std::uint32_t f, Vec3 point) const {
    return dot(faces_[f].normal, point) - distance_[f] > kVisible * m_.scale;
  }
  void take_away(std::uint32_t f) {
    distance_[f] = INFINITY;
    w_.visible.push_back(f);
  }
  void walk_horizon(HalfEdge into, Vec3 point);
  std::uint32_t new_face();
  SATCHECK_INLINE bool add_fan(std::uint32_t apex);
  // The planes of a fan's faces `slots`, over the loop x, y, z. False when a triangle is thinner than noise.
  SATCHECK_INLINE bool set_planes(const std::uint32_t* slots, std::size_t count, Vec3 apex);

  const MinkowskiDifference& m_;
  std::vector<SupportPoint>& vertices_;
  std::vector<Face>& faces_;
  std::vector<double>& distance_;
  Workspace& w_;
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
  // The base, as a fan of one face, and the fan from its edges to the last vertex.
  Face& base = faces_[new_face()];
  for (std::uint32_t i = 0; i < 3; ++i) {
    base.vertex[i] = i;
    w_.add_to_loop(vertices_[i].w);
  }
  const std::uint32_t slot = 0;
  if (!set_planes(&slot, 1, vertices_[2].w)) return false;
  w_.horizon = {0, 2, 1};
  return add_fan(3);
}

std::uint32_t ExpandingPolytope::new_face() {
  const auto slot = static_cast<std::uint32_t>(faces_.size());
  faces_.emplace_back();
  if (distance_.size() < faces_.size()) distance_.resize(distance_.size() + 4, INFINITY);
  return slot;
}

SATCHECK_INLINE bool ExpandingPolytope::set_planes(const std::uint32_t* slots, std::size_t count, Vec3 apex) {
  const Lanes px = all_lanes(apex.x), py = all_lanes(apex.y), pz = all_lanes(apex.z);
  const double thin = kFlat * m_.scale;
  w_.pad_loop();
  for (std::size_t i = 0; i < count; i += 4) {
    const double *x = w_.x.data() + i, *y = w_.y.data() + i, *z = w_.z.data() + i;
    const Lanes tx = load_lanes(x), ty = load_lanes(y), tz = load_lanes(z);
    const Lanes hx = load_lanes(x + 1), hy = load_lanes(y + 1), hz = load_lanes(z + 1);
    const Lanes ax = hx - tx, ay = hy - ty, az = hz - tz;  // tail to head
    const Lanes bx = px - hx, by = py - hy, bz = pz - hz;  // head to apex
    const Lanes cx = tx - px, cy = ty - py, cz = tz - pz;  // apex to tail
    const Lanes aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
    // The cross product of the two shortest edges carries the least rounding error.
    const LaneMask a_shorter = (aa < bb) | (aa < cc), b_shorter = bb < cc;
    const auto first = [&](Lanes a, Lanes b, Lanes c) { return select(a_shorter, select(b_shorter, a, c), b); };
    const auto second = [&](Lanes a, Lanes b, Lanes c) { return select(a_shorter, select(b_shorter, b, a), c); };
    const Lanes ux = first(ax, bx, cx), uy = first(ay, by, cy), uz = first(az, bz, cz);
    const Lanes vx = second(ax, bx, cx), vy = second(ay, by, cy), vz = second(az, bz, cz);
    const Lanes nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const Lanes area_squared = nx * nx + ny * ny + nz * nz;  // twice the area
    const Lanes longest_squared = select(a_shorter, select(b_shorter, cc, bb), aa);
    const Lanes shortest_squared = select(a_shorter, select(b_shorter, aa * bb, aa * cc), bb * cc);
    const Lanes inverse = all_lanes(1) / square_root(area_squared);
    const Lanes stretch_squared = shortest_squared * inverse * inverse;
    const Lanes mx = nx * inverse, my = ny * inverse, mz = nz * inverse;
    const Lanes distance = mx * tx + my * ty + mz * tz;
    const std::size_t lanes = std::min<std::size_t>(4, count - i);
    const int wide_enough = bits_of(area_squared > longest_squared * all_lanes(thin * thin));
    if ((~wide_enough & ((1 << lanes) - 1)) != 0) return false;
    for (std::size_t l = 0; l < lanes; ++l) {
      Face& face = faces_[slots[i + l]];
      face.normal = {mx[l], my[l], mz[l]};
      face.stretch_squared = stretch_squared[l];
      distance_[slots[i + l]] = distance[l];
    }
  }
  return true;
}

// In the order of the loop around what the point sees: from an edge on over the other two of its face.
void ExpandingPolytope::walk_horizon(HalfEdge into, Vec3 point) {
  const std::uint32_t f = face_of(into), next = after(corner_of(into));
  if (!is_alive(f)) return;
  if (!sees(f, point)) {
    w_.horizon.push_back(into);
    return;
  }
  take_away(f);
  walk_horizon(faces_[f].twin[next], point);
  walk_horizon(faces_[f].twin[after(next)], point);
}

// Faces from the edges of the horizon to a vertex. They take the places of the visible ones first.
SATCHECK_INLINE bool ExpandingPolytope::add_fan(std::uint32_t apex) {
  const std::size_t count = w_.horizon.size();
  w_.clear_loop();
  while (w_.visible.size() < count) w_.visible.push_back(new_face());
  const std::uint32_t* slots = w_.visible.data();
  std::uint32_t previous = slots[count - 1];
  const HalfEdge last = w_.horizon[count - 1];
  std::uint32_t expected = faces_[face_of(last)].vertex[corner_of(last)];
  for (std::size_t i = 0; i < count; ++i) {
    const HalfEdge across = w_.horizon[i];
    Face& hidden = faces_[face_of(across)];
    const std::uint32_t head = hidden.vertex[corner_of(across)], tail = hidden.vertex[after(corner_of(across))];
    if (tail != expected) return false;  // the horizon is not one loop
    expected = head;
    hidden.twin[corner_of(across)] = 4 * slots[i];
    Face& face = faces_[slots[i]];
    face.vertex[0] = tail;
    face.vertex[1] = head;
    face.vertex[2] = apex;
    face.twin[0] = across;
    face.twin[2] = 4 * previous + 1;
    faces_[previous].twin[1] = 4 * slots[i] + 2;
    previous = slots[i];
    w_.add_to_loop(vertices_[tail].w);
  }
  w_.add_to_loop(vertices_[expected].w);
  return set_planes(slots, count, vertices_[apex].w);
}

SATCHECK_INLINE bool ExpandingPolytope::expand(const SupportPoint& point, std::uint32_t seed_face) {
  w_.horizon.clear();
  w_.visible.clear();
  take_away(seed_face);
  for (const HalfEdge into : {0, 1, 2}) walk_horizon(faces_[seed_face].twin[into], point.w);
  if (w_.horizon.size() < 3) return false;
  vertices_.push_back(point);
  return add_fan(static_cast<std::uint32_t>(vertices_.size() - 1));
}

// The facet with the weights of the origin's projection onto its plane, clamped to the facet.
Simplex weighted_facet(const ExpandingPolytope& polytope, std::uint32_t f) {
  const Face& face = polytope.face(f);
  const Vec3 foot = face.normal * polytope.distance(f);
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
    const Vec3 normal = polytope.face(f).normal;
    const double distance = polytope.distance(f);
    const SupportPoint w = m.support(normal);
    const double support = dot(normal, w.w);
    ++result.iterations;
    const bool facet_of_difference = support - distance <= closed || polytope.has_vertex(f, w);
    if (support < result.upper || facet_of_difference) {
      result.upper = support;
      result.axis = normal;
    }
    if (support < -noise) {
      result.status = EpaResult::Status::separated;
      return result;
    }
    if (goal == EpaGoal::sign && distance > noise && polytope.least_proven_distance(f) > noise) {
      result.lower = polytope.least_proven_distance(f);
      result.status = EpaResult::Status::depth;
      return result;
    }
    if (facet_of_difference) {
      // On curved shapes the last facets are splinters: what was proven before may be more.
      result.lower = std::max(m.curved ? result.lower : -INFINITY, polytope.least_proven_distance(f));
      result.facet = weighted_facet(polytope, f);
      result.status = EpaResult::Status::depth;
      return result;
    }
    // A vertex that is there already and still outside a face: rounding has bent the polytope, and
    // going on could go on for ever. What was proven so far stands.
    if (m.curved) {
      result.lower = std::max(result.lower, polytope.least_proven_distance(f));
      result.status = EpaResult::Status::bounded;
      if (result.iterations >= kCurvedExpansions) return result;
    } else {
      result.lower = distance - m.support_error();
    }
    if (polytope.contains(w) || !polytope.expand(w, f)) return result;
  }
}

}  // namespace satcheck
