// Every tolerance of the convex narrow phase, with its derivation. All are multiples of the unit
// roundoff times `scale`, the largest coordinate that can appear in the pair: no absolute epsilons.
#pragma once

#include <limits>

namespace satcheck {

// Unit roundoff of float64.
inline constexpr double kUnitRoundoff = std::numeric_limits<double>::epsilon() / 2;

// |computed - true| of a support value n.(a - b) for a unit axis n is at most this many roundoffs
// of the scale. Relative pose: 2 products of rounded 3x3 matrices, 6 roundings a coordinate, 3
// coordinates, 18; dot product of 3 terms, 3 roundings, 9 after the sum over coordinates; length of
// the axis itself, 2 roundings; difference of the two supports, 1; rounded up to 40.
inline constexpr double kSupportError = 40 * kUnitRoundoff;

// The same where a shape is curved, for the rotations that the quaternions name: an entry of a rounded
// matrix is off by up to 17 roundoffs on the diagonal (length of the quaternion 5, products 3, both times 2,
// and 1) and 8 beside it, 36 in the norm, for each of the two poses; with the 40 of above, rounded up.
inline constexpr double kCurvedSupportError = 128 * kUnitRoundoff;

// EPA takes a support point as outside a face only beyond this fraction of the scale: below it the
// height is rounding noise, and a face built on it would have a meaningless normal.
inline constexpr double kVisible = 16 * kUnitRoundoff;

// A simplex, or a Minkowski difference, is flat when it is thinner than this fraction of the scale. As an
// angle it bounds what the rounding of two unit vectors, 15 roundoffs, does to their cross product, and
// that, times sqrt(3) for the farthest support point, to a support value.
inline constexpr double kFlat = 64 * kUnitRoundoff;

// Bounds of curved shapes close only in the limit; GJK stops at this fraction of the scale.
inline constexpr double kCurvedGap = 1e-11;

// EPA stops earlier on curved shapes. A facet of width s leaves a gap of about s^2 / 8, and the support
// errors turn its normal by 40 roundoffs / s: below s = 1e-4, that is a gap of 1e-9, the proven bounds
// drift apart again. Newton's method adds the last digits of the axis, not of the proof.
inline constexpr double kCurvedFacetGap = 1e-9;

// Where all ways out are equally long (concentric balls, cylinders) the bounds of EPA close with the
// number of facets only. After so many expansions of a curved pair the bounds reached are the answer.
inline constexpr int kCurvedExpansions = 512;

// Newton steps on the axis of a curved pair, and the turn of its forward differences (radians), which
// is the square root of the roundoff. From an axis good to 1e-4 two steps reach the last digit.
inline constexpr int kPolishSteps = 4;
inline constexpr double kPolishAngle = 1e-8;

// Two segments with sin^2 of their angle below this count as parallel where their common points are sought.
inline constexpr double kParallelSquared = 1e-12;

// Arcs on the Gauss map whose end points come this close to the other arc's plane may or may not
// cross: their axis is projected in full instead of trusted.
inline constexpr double kArcUncertain = 1e-7;

// An axis rounded by more than this (radians) does not serve as a filter: its exact sign is taken.
inline constexpr double kTrustedAxis = 1e-6;

// Penetrations that SAT on hulls finds below this fraction of the scale are confirmed by exact signs, because
// the stored normal of a sliver face carries more error than a support value does.
inline constexpr double kShallow = 1e-7;

// Where the proven bounds of two polytopes are further apart than this fraction of the scale, or the rounding
// of their placement is more, the exact stage takes over. On facets of ordinary shape float64 leaves 1e-14 to 1e-13; slivers cost it more.
inline constexpr double kWidestInterval = 1e-12;

// A short chain of operations on coordinates (a rotation, a translation, a scaling about a point: fewer than 16
// roundings of at most one roundoff of the largest intermediate each, which is below 4 times the largest
// coordinate) stays within this many roundoffs of that coordinate.
inline constexpr double kChainRoundoffs = 64;

inline double chain_rounding(double largest_coordinate) {
  return kChainRoundoffs * kUnitRoundoff * largest_coordinate;
}

// Columns of a transform whose cosines are below this count as perpendicular: the box that it carries is
// then padded by the same fraction of its size, which covers what the cosines neglect.
inline constexpr double kOrthogonality = 1e-12;

// How far the rounding of a pose moves a point at most, as a fraction of the largest of its coordinates and
// those of the translation: 3 products, 2 sums and the translation make 6 roundings a coordinate, times
// sqrt(3) for the vector.
inline constexpr double kPlacementError = 11 * kUnitRoundoff;

// Vertices this close to a support plane, as a fraction of the scale, belong to the contact feature.
inline constexpr double kSameFeature = 1e-10;

}  // namespace satcheck
