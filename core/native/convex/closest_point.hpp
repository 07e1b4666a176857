// The point of the hull of up to four points that is closest to the origin.
//
// Deviation from Ericson, "Real-Time Collision Detection" (2004), 5.1, and from Montanari, Petrinic and Barbieri,
// "Improving the GJK Algorithm" (2017): no chain of region tests. The inside of a face counts only when all its
// weights are positive; otherwise the edges of non-positive weight compete by distance, so a misjudged sign costs
// accuracy in the last digit, not the region.
//
// Inlined into loops that are compiled for wide registers as a whole.
#pragma once

#include "base/lanes.hpp"
#include "base/rounding.hpp"
#include "base/vec.hpp"

namespace satcheck {

struct ClosestPoint {
  Vec3 v;
  double distance_squared = INFINITY;  // INFINITY: no candidate survived rounding
  unsigned carriers = 0;               // bit i: point i carries v. None, at distance 0: origin inside
  double share[4] = {0, 0, 0, 0};      // proportional to the weights of the carriers

  bool encloses() const { return distance_squared == 0 && carriers == 0; }
};

// Edges and faces of a tetrahedron by their corners, and for each face the edges opposite to its corners.
inline constexpr unsigned kEdge[6][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};
inline constexpr unsigned kFace[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
inline constexpr unsigned kOpposite[4][3] = {{2, 1, 0}, {4, 3, 0}, {5, 3, 1}, {5, 4, 2}};

// Up to four points, and the closest point found on them. Edges and faces are compile-time constants, so that no index
// has to be loaded.
class ClosestPointSearch {
 public:
  SATCHECK_INLINE ClosestPointSearch(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) : point_{a, b, c, d} {}

  template <unsigned i>
  SATCHECK_INLINE void offer_vertex() {
    const double distance_squared = norm_squared(point_[i]);
    if (!(distance_squared < best_.distance_squared)) return;
    best_.v = point_[i];
    best_.distance_squared = distance_squared;
    best_.carriers = 1u << i;
    best_.share[i] = 1;
  }

  template <unsigned edge>
  SATCHECK_INLINE void offer_edge() {
    constexpr unsigned i = kEdge[edge][0], j = kEdge[edge][1];
    const Vec3 p = point_[i], q = point_[j], e = q - p;
    const double length_squared = norm_squared(e), along = -dot(p, e);
    if (!(along > 0)) return offer_vertex<i>();
    if (!(along < length_squared)) return offer_vertex<j>();
    // The foot is measured from the nearer end, where cancellation is least.
    const double t = along / length_squared;
    Vec3 v = t <= 0.5 ? p + e * t : q - e * (dot(q, e) / length_squared);
    // Cancellation leaves a component along the edge. Without this component, the whole edge has one support value, and
    // the duality gap can close even if v is very small.
    v = v - e * (dot(v, e) / length_squared);
    const double distance_squared = norm_squared(v);
    if (!(distance_squared < best_.distance_squared)) return;
    best_.v = v;
    best_.distance_squared = distance_squared;
    best_.carriers = 1u << i | 1u << j;
    best_.share[i] = 1 - t;
    best_.share[j] = t;
  }

  // Tries the inside of the face, else those of its edges that are in `edges`.
  template <unsigned face, unsigned edges>
  SATCHECK_INLINE void offer_face() {
    constexpr unsigned i = kFace[face][0], j = kFace[face][1], k = kFace[face][2];
    const Vec3 p = point_[i], q = point_[j], r = point_[k];
    const Vec3 n = cross(q - p, r - p);
    const double area_squared = norm_squared(n);
    const double wp = dot(n, cross(q, r)), wq = dot(n, cross(r, p)), wr = dot(n, cross(p, q));
    if (wp > 0 && wq > 0 && wr > 0) {
      // Along the normal and not as a weighted sum, so that the direction is accurate even if the plane is very close.
      const Vec3 v = n * (dot(n, p) / area_squared);
      const double distance_squared = norm_squared(v);
      if (!(distance_squared < best_.distance_squared)) return;
      best_.v = v;
      best_.distance_squared = distance_squared;
      best_.carriers = 1u << i | 1u << j | 1u << k;
      best_.share[i] = wp;
      best_.share[j] = wq;
      best_.share[k] = wr;
      return;
    }
    if ((edges >> kOpposite[face][0] & 1) && !(wp > 0)) offer_edge<kOpposite[face][0]>();
    if ((edges >> kOpposite[face][1] & 1) && !(wq > 0)) offer_edge<kOpposite[face][1]>();
    if ((edges >> kOpposite[face][2] & 1) && !(wr > 0)) offer_edge<kOpposite[face][2]>();
  }

  // Tries the faces given as bits.
  template <unsigned edges>
  SATCHECK_INLINE void offer_faces(unsigned faces) {
    if (faces & 1) offer_face<0, edges>();
    if (faces & 2) offer_face<1, edges>();
    if (faces & 4) offer_face<2, edges>();
    if (faces & 8) offer_face<3, edges>();
  }

  const ClosestPoint& best() const { return best_; }

 private:
  const Vec3 point_[4];
  ClosestPoint best_;
};

// Signed volumes of the origin with each face of a tetrahedron. If the origin is inside, all have the sign of the whole
// volume.
struct Volumes {
  double opposite[4];  // of the face opposite to each vertex
  double whole() const { return opposite[0] + opposite[1] + opposite[2] + opposite[3]; }
  // Faces with the origin on their outer side or on their plane, as bits, by kFace.
  SATCHECK_INLINE unsigned outside() const {
    const double w = whole();
    return unsigned{!(opposite[3] * w > 0)} | unsigned{!(opposite[2] * w > 0)} << 1 | unsigned{!(opposite[1] * w > 0)} << 2 |
           unsigned{!(opposite[0] * w > 0)} << 3;
  }
};

SATCHECK_INLINE Volumes volumes_of_origin(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return {{dot(b, cross(d, c)), dot(a, cross(c, d)), dot(a, cross(d, b)), dot(a, cross(b, c))}};
}

// The closest point on the first `count` points. `last_is_needed`: the closest point needs the last point, so hulls of
// the other points are skipped.
template <bool last_is_needed>
SATCHECK_INLINE ClosestPoint closest_point(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int count) {
  ClosestPointSearch search(a, b, c, d);
  if (count == 1) {
    search.offer_vertex<0>();
  } else if (count == 2) {
    search.offer_edge<0>();
  } else if (count == 3) {
    search.offer_face<0, last_is_needed ? 0b000110u : 0b000111u>();
  } else {
    const unsigned outside = volumes_of_origin(a, b, c, d).outside();
    if (outside == 0) return {{0, 0, 0}, 0};
    if constexpr (last_is_needed) {
      search.offer_faces<0b111000u>(outside & 0b1110u);
    } else {
      search.offer_faces<0b111111u>(outside);
    }
  }
  return search.best();
}

// A lower bound of the radius of the largest ball around the origin in a tetrahedron, apart from the rounding of the
// vertices. 0 or less if the origin may lie outside.
//
// The height of the origin over a face is 6 times the volume divided by twice the area. Twice the area is at most (2
// r)^2 if all vertices lie within r. A volume is a sum of products of 3 factors up to r, so its error is at most 12
// roundoffs of sqrt(3) r^3.
SATCHECK_INLINE double enclosed_radius(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Volumes v = volumes_of_origin(a, b, c, d);
  const double sign = v.opposite[0] > 0 ? 1 : -1;
  const double least = smaller(smaller(sign * v.opposite[0], sign * v.opposite[1]), smaller(sign * v.opposite[2], sign * v.opposite[3]));
  const double farthest_squared = larger(larger(norm_squared(a), norm_squared(b)), larger(norm_squared(c), norm_squared(d)));
  return least / (4 * farthest_squared) - 8 * kUnitRoundoff * std::sqrt(farthest_squared);
}

}  // namespace satcheck
