// Points with rational coordinates, for samples that no float64 point can be.
#pragma once

#include "base/vec.hpp"
#include "exact/dyadic.hpp"

namespace satcheck {

// The point (x, y, z) / w, w > 0, and its rounding.
struct ExactPoint {
  Dyadic x, y, z, w;
  Vec3 rounded;
  Vec3 error;  // |rounded - exact| per coordinate
};

ExactPoint make_exact_point(Vec3 p);
ExactPoint make_exact_point(Dyadic x, Dyadic y, Dyadic z, Dyadic w);

// (wa a + wb b + wc c) / (wa + wb + wc), weights of one sign, not all zero.
ExactPoint weighted_point(Vec3 a, Vec3 b, Vec3 c, const Dyadic& wa, const Dyadic& wb, const Dyadic& wc);

// (wp p + wq q) / (wp + wq), weights of one sign, not both zero.
ExactPoint between(const ExactPoint& p, const ExactPoint& q, const Dyadic& wp, const Dyadic& wq);

// The value whose sign is orientation(a, b, c, d).
Dyadic orientation_value(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

// Where the line through p and q, on strictly different sides of the plane of a, b, c, meets it.
ExactPoint plane_meeting_point(Vec3 a, Vec3 b, Vec3 c, Vec3 p, Vec3 q);

bool operator==(const ExactPoint& p, const ExactPoint& q);

// The predicates of predicates.hpp with an exact point in the last place.
int orientation(Vec3 a, Vec3 b, Vec3 c, const ExactPoint& d);
int orientation_2d_at(Vec3 a, Vec3 b, const ExactPoint& p, int drop_axis);
int orientation_2d_at(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int drop_axis);

// The value with that sign, times a positive factor that depends on a and b alone and times c.w.
Dyadic area_value(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int drop_axis);

inline const Dyadic& coordinate(const ExactPoint& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

// The axes that remain when one is dropped, so that the projection keeps the orientation.
struct PlaneAxes {
  int i, j;
};
inline PlaneAxes plane_axes(int drop_axis) {
  return {drop_axis == 2 ? 0 : drop_axis + 1, drop_axis == 0 ? 2 : drop_axis - 1};
}

inline Aabb point_box(const ExactPoint& p) { return {p.rounded - p.error, p.rounded + p.error}; }
inline Vec3 rounded_point(const ExactPoint& p) { return p.rounded; }

}  // namespace satcheck
