// Bounds of rounding errors, and the thresholds of the convex narrow phase, each with its derivation. Lengths are
// fractions of `scale`, the largest coordinate that can appear in the pair: no absolute epsilons.
#pragma once

#include <limits>

namespace satcheck {

// Unit roundoff of float64.
inline constexpr double kUnitRoundoff = std::numeric_limits<double>::epsilon() / 2;

// |computed - true| of a support value n.(a - b) for a unit axis n is at most this many roundoffs
// of the scale. Relative pose: 2 products of rounded 3x3 matrices with 6 roundings for each of 3 coordinates, 18. Dot
// product of 3 terms: 3 roundings, 9 in the sum over coordinates. Length of the axis: 2. Difference of the two
// supports: 1. The sum is rounded up to 40.
inline constexpr double kSupportError = 40 * kUnitRoundoff;

// The same for curved shapes, relative to the exact rotations of the quaternions. An entry of a rounded matrix has an
// error of up to 17 roundoffs on the diagonal (length of the quaternion 5, products 3, both times 2, plus 1) and 8 off
// the diagonal. The norm of the error is 36 for each of the two poses. With the 40 from above, rounded up.
inline constexpr double kCurvedSupportError = 128 * kUnitRoundoff;

// EPA counts a support point as outside a face only beyond this fraction of the scale. Smaller heights are rounding
// noise, and a face built on such a point would have a meaningless normal.
inline constexpr double kVisible = 16 * kUnitRoundoff;

// A simplex, or a Minkowski difference, is flat when it is thinner than this fraction of the scale. As an angle, it
// bounds the error of the cross product of two unit vectors that are off by 15 roundoffs. Times sqrt(3), for the
// farthest support point, this is the error of a support value.
inline constexpr double kFlat = 64 * kUnitRoundoff;

// Bounds of curved shapes close only in the limit; GJK stops at this fraction of the scale.
inline constexpr double kCurvedGap = 1e-11;

// EPA stops earlier on curved shapes. A facet of width s leaves a gap of about s^2 / 8, and the support errors turn its
// normal by 40 roundoffs / s. Below s = 1e-4, which is a gap of 1e-9, the proven bounds diverge again. Newton's method
// improves the last digits of the axis, but not the proof.
inline constexpr double kCurvedFacetGap = 1e-9;

// If all translations out are equally long (concentric balls, cylinders), the bounds of EPA close only with the number
// of facets. After this many expansions of a curved pair, the current bounds are the answer.
inline constexpr int kCurvedExpansions = 512;

// Newton steps on the axis of a curved pair, and the angle of its forward differences (radians), which is the square
// root of the roundoff. If the axis is accurate to 1e-4, two steps reach the last digit.
inline constexpr int kPolishSteps = 4;
inline constexpr double kPolishAngle = 1e-8;

// Two segments count as parallel if sin^2 of their angle is below this, when their common points are computed.
inline constexpr double kParallelSquared = 1e-12;

// If an end point of an arc on the Gauss map is this close to the other arc's plane, the arcs may or may not cross.
// Both shapes are then projected completely on their axis.
inline constexpr double kArcUncertain = 1e-7;

// If SAT on hulls finds a penetration below this fraction of the scale, exact signs confirm it, because the stored
// normal of a sliver face has a larger error than a support value.
inline constexpr double kShallow = 1e-7;

// The exact stage takes over if the proven bounds of two polytopes differ by more than this fraction of the scale, or
// if the rounding of their placement is larger. On well-shaped facets, float64 bounds differ by 1e-14 to 1e-13; on
// slivers by more.
inline constexpr double kWidestInterval = 1e-12;

// A short chain of operations on coordinates (a rotation, a translation, a scaling about a point: fewer than 16
// roundings of at most one roundoff of the largest intermediate each, which is below 4 times the largest
// coordinate) stays within this many roundoffs of that coordinate.
inline constexpr double kChainRoundoffs = 64;

inline double chain_rounding(double largest_coordinate) {
  return kChainRoundoffs * kUnitRoundoff * largest_coordinate;
}

// Columns of a transform count as perpendicular if their cosines are below this. A transformed box is then padded by
// the same fraction of its size, which covers the neglected cosines.
inline constexpr double kOrthogonality = 1e-12;

// The largest distance that the rounding of a pose moves a point, as a fraction of the largest coordinate of the point
// and the translation. 3 products, 2 sums and the translation make 6 roundings for each coordinate, times sqrt(3) for
// the vector.
inline constexpr double kPlacementError = 11 * kUnitRoundoff;

// Vertices this close to a support plane, as a fraction of the scale, belong to the contact feature.
inline constexpr double kSameFeature = 1e-10;

}  // namespace satcheck
