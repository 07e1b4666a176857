// No branch depends on coordinates until the end (box_axes.hpp). Values that depend on the axis are read from tables.
#include "convex/box_pair.hpp"

#include "convex/box_axes.hpp"
#include "convex/pair_order.hpp"
#include "convex/minkowski.hpp"

namespace satcheck {

namespace {

// The largest 1 / sine of the angle of two edges for which their crossing is well conditioned.
constexpr double kCrossing = 1e3;

// The boxes in the order in which they are compared.
struct OrderedBoxes {
  const Shape *a, *b;
  const Pose *pose_a, *pose_b;
  bool swapped;
};

SATCHECK_INLINE OrderedBoxes in_order(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const bool swapped = !comes_before(a, pose_a, b, pose_b);
  return {swapped ? &b : &a, swapped ? &a : &b, swapped ? &pose_b : &pose_a, swapped ? &pose_a : &pose_b, swapped};
}

// A hull that is a box has a frame of its own, turned against that of the shape.
Mat3 box_to_world(const Shape& s, const Pose& pose) {
  if (s.kind == ShapeKind::box) return pose.rotation;
  Mat3 turned;
  for (int i = 0; i < 3; ++i) turned.row[i] = transpose_times(s.box->rotation, pose.rotation.row[i]);
  return turned;
}

Vec3 half_of(const Shape& s) { return s.kind == ShapeKind::box ? s.size : s.box->half; }

double error_of(const Shape& s) { return s.box ? s.box->error : 0; }

// From the origin of the core to the middle of the box, in the world.
Vec3 middle_of(const Shape& s, const Pose& pose) {
  return s.kind == ShapeKind::box ? Vec3{} : pose.rotation * s.box->centre;
}

// Not for hulls.
SATCHECK_INLINE PlacedBoxes placed_boxes(const OrderedBoxes& o) {
  const Vec3 between = o.pose_b->translation - o.pose_a->translation;
  return placed_boxes(o.pose_a->rotation, o.a->size, o.pose_b->rotation, o.b->size, between, o.a->extent + o.b->extent);
}

// The feature of the axis, by LeastOverlap::kind; 3: none. A and B are in the given order.
struct PairFeature {
  Feature feature;
  std::uint32_t index_a, index_b;
};

SATCHECK_INLINE PairFeature feature_of(int kind, int i, int k, bool swapped) {
  static constexpr Feature seen[2][4] = {{Feature::face_a, Feature::face_b, Feature::edge_edge, Feature::none},
                                  {Feature::face_b, Feature::face_a, Feature::edge_edge, Feature::none}};
  static constexpr std::uint32_t hides[4][2] = {{0, kNoIndex}, {kNoIndex, 0}, {0, 0}, {kNoIndex, kNoIndex}};
  static_assert(kNoIndex == ~std::uint32_t{0});
  const std::uint32_t of_a = static_cast<std::uint32_t>(i) | hides[kind][0], of_b = static_cast<std::uint32_t>(k) | hides[kind][1];
  return {seen[swapped][kind], swapped ? of_b : of_a, swapped ? of_a : of_b};
}

struct ContactPoints {
  Lanes on_a, on_b;  // frame of A; on_a - on_b = penetration * axis
  bool sole;
};

// By kind of axis and axis of the box: 0 if witness points have to lie over the face or within the edge.
constexpr double kFar = INFINITY;
constexpr double kSlackA[3][3][4] = {{{kFar, 0, 0, kFar}, {0, kFar, 0, kFar}, {0, 0, kFar, kFar}},
                                     {{kFar, kFar, kFar, kFar}, {kFar, kFar, kFar, kFar}, {kFar, kFar, kFar, kFar}},
                                     {{0, kFar, kFar, kFar}, {kFar, 0, kFar, kFar}, {kFar, kFar, 0, kFar}}};
constexpr double kSlackB[3][3][4] = {{{kFar, kFar, kFar, kFar}, {kFar, kFar, kFar, kFar}, {kFar, kFar, kFar, kFar}},
                                     {{kFar, 0, 0, kFar}, {0, kFar, 0, kFar}, {0, 0, kFar, kFar}},
                                     {{0, kFar, kFar, kFar}, {kFar, 0, kFar, kFar}, {kFar, kFar, 0, kFar}}};

// The contact of a corner of B with a face of A, of a corner of A with a face of B, or of two edges that cross, seen
// along the axis.
SATCHECK_INLINE ContactPoints contact_points(const PlacedBoxes& boxes, const LeastOverlap& least) {
  const Lanes n = least.axis, against = -least.axis_in_b, way = n * least.penetration;
  const bool edges = least.kind == 2;
  // For edges, their middles, which are 0 along the edge.
  static constexpr double keeps[4][4] = {{0, 1, 1, 0}, {1, 0, 1, 0}, {1, 1, 0, 0}, {1, 1, 1, 0}};
  const Lanes of_a = with_sign_of(n, boxes.half_a) * load_lanes(keeps[edges ? least.i : 3]);
  const Lanes in_b = with_sign_of(against, boxes.half_b) * load_lanes(keeps[edges ? least.k : 3]);
  const Lanes of_b = combine(boxes.a_in_b.row, in_b) + boxes.offset;
  // The position of the crossing along A's edge, from its component perpendicular to B's edge.
  const Lanes e = unit_lane(least.i), across_f = e - boxes.a_in_b.row[least.k] * boxes.b_in_a.row[least.i][least.k];
  const Lanes apart = across_f * (of_b - of_a + way);
  const double s = (apart[0] + apart[1] + apart[2]) * (least.inverse_sine * least.inverse_sine);
  const Lanes points[3] = {of_b + way, of_a, of_a + e * s};
  const Lanes on_a = points[least.kind], on_b = on_a - way;

  const Lanes placed_in_b = combine(boxes.b_in_a.row, on_b - boxes.offset);
  const LaneMask beside = (abs(on_a) > boxes.half_a + load_lanes(kSlackA[least.kind][least.i])) |
                          (abs(placed_in_b) > boxes.half_b + load_lanes(kSlackB[least.kind][least.k]));
  // For a face, a single corner of the other box is nearest.
  static constexpr double least_slope[3][2] = {{0, kSameFeature}, {kSameFeature, 0}, {0, 0}};
  const LaneMask level = (abs(n) < all_lanes(least_slope[least.kind][0])) | (abs(against) < all_lanes(least_slope[least.kind][1]));
  const bool crosses = !edges | (least.inverse_sine < kCrossing), none = bits_of_three(beside | level) == 0;
  return {on_a, on_b, static_cast<bool>(crosses & none)};
}

SATCHECK_INLINE Vec3 vec3(Lanes v) { return {v[0], v[1], v[2]}; }

}  // namespace

SATCHECK_WIDE BoxContact contact_of_boxes(const MinkowskiDifference& m, const Pose& pose_a, const Pose& pose_b) {
  const Shape &a = m.a, &b = m.b;
  const Vec3 between = offset_between(a, pose_a, b, pose_b) + (middle_of(b, pose_b) - middle_of(a, pose_a));
  const Vec3 half_a = half_of(a), half_b = half_of(b);
  const PlacedBoxes boxes = placed_boxes(box_to_world(a, pose_a), half_a, box_to_world(b, pose_b), half_b, between,
                                         max_abs(half_a) + max_abs(half_b));
  LeastOverlap least = least_overlap(boxes);
  BoxContact found;
  found.noise = proof_noise(boxes.scale, placement_error(a, pose_a), placement_error(b, pose_b)) + error_of(a) + error_of(b);
  Vec3 axis = vec3(least.axis);
  if (a.kind != ShapeKind::box) axis = a.box->rotation * axis;
  if (a.kind != ShapeKind::box || b.kind != ShapeKind::box) {
    // The vertices of the hulls give the figure its last digits.
    least.penetration = dot(axis, m.support(axis).w);
  }
  const ContactPoints contact = contact_points(boxes, least);
  found.witness = {vec3(contact.on_a), vec3(contact.on_b)};
  if (a.kind != ShapeKind::box) {
    for (Vec3* p : {&found.witness.a, &found.witness.b}) *p = a.box->rotation * *p + a.box->centre;
  }
  found.sole = contact.sole;
  const PairFeature feature = feature_of(least.kind, least.i, least.k, false);
  found.sat = {least.penetration, least.lower, axis, feature.feature, feature.index_a, feature.index_b, 15};
  return found;
}

// The verdict of the axes, and the axis that separates.
SATCHECK_INLINE PairResult by_axes(Outcome outcome, PairFeature named, int axes_tested) {
  PairResult result;
  result.outcome = outcome;
  result.method = Method::sat;
  result.feature = named.feature;
  result.index_a = named.index_a;
  result.index_b = named.index_b;
  result.axes_tested = axes_tested;
  return result;
}

constexpr PairFeature kNoFeature{Feature::none, kNoIndex, kNoIndex};

SATCHECK_WIDE PairResult overlap_of_boxes(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const OrderedBoxes ordered = in_order(a, pose_a, b, pose_b);
  const double error_a = placement_error(*ordered.a, *ordered.pose_a), error_b = placement_error(*ordered.b, *ordered.pose_b);
  const PlacedBoxes boxes = placed_boxes(ordered);
  BoxAxes axes;
  measure_faces(boxes, axes);
  const double noise = proof_noise(boxes.scale, error_a, error_b);
  const Lanes some = all_lanes(noise), none = all_lanes(-noise);
  // Four bits for each triple of axes: those along which the boxes are apart by more than noise.
  const int faces = bits_of_three(axes.overlap[0] < none) | bits_of_three(axes.overlap[1] < none) << 4;
  if (faces != 0) {
    const int first = std::countr_zero(static_cast<unsigned>(faces)), k = first & 3;
    return by_axes(Outcome::separated, feature_of(first >> 2, k, k, ordered.swapped), 6);
  }
  measure_edges(boxes, axes);
  // A cross product of two unit axes is no longer than 1, up to its rounding: it shows no larger overlap than its unit
  // axis. Crossings that are far shorter are left to the comparison below.
  const Lanes least = smaller(smaller(axes.overlap[0], axes.overlap[1]),
                              smaller(axes.overlap[2], smaller(axes.overlap[3], axes.overlap[4])));
  if (bits_of_three(least < some * (1 + kSupportError)) == 0) {
    return by_axes(Outcome::penetrating, kNoFeature, 15);
  }
  LaneMask open = (axes.overlap[0] < some) | (axes.overlap[1] < some);
  for (int i = 0; i < 3; ++i) {
    // Compared with noise times the length, squared. For parallel edges both sides are 0, which excludes no axis.
    const Lanes overlap = signed_square(axes.overlap[2 + i]), limit = all_lanes(noise * noise) * axes.length_squared[i];
    if (const int apart = bits_of_three(overlap < -limit)) {
      const int k = std::countr_zero(static_cast<unsigned>(apart));
      return by_axes(Outcome::separated, feature_of(2, i, k, ordered.swapped), 15);
    }
    open = open | (overlap < limit);
  }
  return by_axes(bits_of_three(open) != 0 ? Outcome::undecided : Outcome::penetrating, kNoFeature, 15);
}

SATCHECK_WIDE PairResult depth_of_boxes(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const OrderedBoxes ordered = in_order(a, pose_a, b, pose_b);
  const double error_a = placement_error(*ordered.a, *ordered.pose_a), error_b = placement_error(*ordered.b, *ordered.pose_b);
  const PlacedBoxes boxes = placed_boxes(ordered);
  const LeastOverlap least = least_overlap(boxes);
  const ContactPoints contact = contact_points(boxes, least);
  const double noise = proof_noise(boxes.scale, error_a, error_b);
  if (!(least.lower > noise) || !(noise <= kWidestInterval * boxes.scale) || !contact.sole) return {};
  const PairFeature feature = feature_of(least.kind, least.i, least.k, ordered.swapped);
  const LaneMat3 to_world = transposed(lane_mat3(ordered.pose_a->rotation));
  const Lanes normal = combine(to_world.row, least.axis);
  const Lanes origin = three(ordered.pose_a->translation);
  const Vec3 on_a = vec3(combine(to_world.row, contact.on_a) + origin), on_b = vec3(combine(to_world.row, contact.on_b) + origin);
  return {.outcome = Outcome::penetrating,
          .method = Method::sat,
          .feature = feature.feature,
          .index_a = feature.index_a,
          .index_b = feature.index_b,
          .has_distance = true,
          .distance = -least.penetration,
          .lower = -least.penetration - noise,
          .upper = -least.lower + noise,
          .normal = vec3(all_lanes(0) + normal * (ordered.swapped ? -1.0 : 1.0)),  // no negative zeros
          .witness_a = ordered.swapped ? on_b : on_a,
          .witness_b = ordered.swapped ? on_a : on_b,
          .axes_tested = 15};
}

}  // namespace satcheck
