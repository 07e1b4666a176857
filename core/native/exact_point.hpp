// Points with rational coordinates, for samples that no float64 point can be.
#pragma once

#include "dyadic.hpp"
#include "vec.hpp"

namespace satcheck {

// The point (x, y, z) / w, w > 0, and its rounding.
struct ExactPoint {
  Dyadic x, y, z, w;
  Vec3 rounded;
  Vec3 error;  // |rounded - exact| per coordinate
};

ExactPoint make_exact_point(Dyadic x, Dyadic y, Dyadic z, Dyadic w);

// (wa a + wb b + wc c) / (wa + wb + wc), weights of one sign, not all zero.
ExactPoint weighted_point(Vec3 a, Vec3 b, Vec3 c, const Dyadic& wa, const Dyadic& wb, const Dyadic& wc);

// The predicates of predicates.hpp with an exact point in the last place.
int orientation(Vec3 a, Vec3 b, Vec3 c, const ExactPoint& d);
int orientation_2d_at(Vec3 a, Vec3 b, const ExactPoint& p, int drop_axis);

inline Aabb point_box(const ExactPoint& p) { return {p.rounded - p.error, p.rounded + p.error}; }
inline Vec3 rounded_point(const ExactPoint& p) { return p.rounded; }

}  // namespace satcheck
