// Two boxes in one pass, against GJK + EPA on the hulls of their corners, which share nothing with it.
#include "convex/box_pair.hpp"

#include "base/rounding.hpp"
#include "convex/pair_order.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

struct Boxes {
  Shape a, b;
  Pose pose_a, pose_b;
};

Boxes random_boxes(testing::Source& source, double spread) {
  const auto half = [&] { return Vec3{source.uniform(0.1, 1), source.uniform(0.1, 1), source.uniform(0.1, 1)}; };
  return {make_box(half()), make_box(half()), source.pose(spread), source.pose(spread)};
}

constexpr double kScale = 6;  // of the difference of two such boxes, spread 1 or less
constexpr double kNear = 4 * kSupportError * kScale;

// How far a point is outside a placed box; negative inside.
double outside(const Shape& box, const Pose& pose, Vec3 point) {
  const Vec3 p = transpose_times(pose.rotation, point - pose.translation);
  return larger(std::fabs(p.x) - box.size.x, larger(std::fabs(p.y) - box.size.y, std::fabs(p.z) - box.size.z));
}

PairResult from_hulls(const Boxes& boxes, Query query) {
  return check_pair(make_hull(boxes.a.polytope.vertices), boxes.pose_a, make_hull(boxes.b.polytope.vertices), boxes.pose_b, query);
}

void test_overlap_matches_hulls() {
  testing::Source source(3);
  int overlaps = 0, by_edges = 0;
  for (int round = 0; round < 2000; ++round) {
    const Boxes boxes = random_boxes(source, 0.9);
    const PairResult r = overlap_of_boxes(boxes.a, boxes.pose_a, boxes.b, boxes.pose_b);
    CHECK(r.outcome == from_hulls(boxes, Query::overlap).outcome);
    CHECK((r.feature == Feature::none) == (r.outcome == Outcome::penetrating));
    overlaps += r.outcome == Outcome::penetrating;
    by_edges += r.feature == Feature::edge_edge;
  }
  CHECK(overlaps > 500 && overlaps < 1500);
  CHECK(by_edges > 10);
}

void test_depth_matches_hulls() {
  testing::Source source(5);
  int seen[6] = {};
  for (int round = 0; round < 1000; ++round) {
    const Boxes boxes = random_boxes(source, 0.6);
    const PairResult r = depth_of_boxes(boxes.a, boxes.pose_a, boxes.b, boxes.pose_b);
    const PairResult truth = from_hulls(boxes, Query::depth);
    if (truth.outcome != Outcome::penetrating) {
      CHECK(r.outcome == Outcome::undecided);
      continue;
    }
    CHECK(r.outcome == Outcome::penetrating && r.has_distance);
    ++seen[static_cast<int>(r.feature)];
    CHECK(std::fabs(r.distance - truth.distance) <= kNear);
    CHECK(r.lower <= r.distance && r.distance <= r.upper && r.upper - r.lower <= kNear);
    CHECK(std::fabs(norm(r.normal) - 1) <= kNear);
    CHECK(norm(r.witness_b - r.witness_a - r.normal * r.distance) <= kNear);
    CHECK(std::fabs(outside(boxes.a, boxes.pose_a, r.witness_a)) <= kNear);
    CHECK(std::fabs(outside(boxes.b, boxes.pose_b, r.witness_b)) <= kNear);
  }
  CHECK(seen[static_cast<int>(Feature::face_a)] > 50);
  CHECK(seen[static_cast<int>(Feature::face_b)] > 50);
  CHECK(seen[static_cast<int>(Feature::edge_edge)] > 50);
}

void test_either_order_is_the_same_bits() {
  testing::Source source(7);
  for (int round = 0; round < 300; ++round) {
    const Boxes boxes = random_boxes(source, 0.7);
    const PairResult ab = depth_of_boxes(boxes.a, boxes.pose_a, boxes.b, boxes.pose_b);
    const PairResult ba = depth_of_boxes(boxes.b, boxes.pose_b, boxes.a, boxes.pose_a);
    CHECK(ab.outcome == ba.outcome);
    if (ab.outcome != Outcome::penetrating) continue;
    CHECK(ab.distance == ba.distance && ab.normal == -ba.normal);
    CHECK(ab.witness_a == ba.witness_b && ab.witness_b == ba.witness_a);
    CHECK(ab.index_a == ba.index_b && ab.index_b == ba.index_a);
  }
}

// Poses or their difference lead to the same axes.
void test_difference_gives_the_same_bits() {
  testing::Source source(9);
  for (int round = 0; round < 300; ++round) {
    const Boxes boxes = random_boxes(source, 0.7);
    if (!comes_before(boxes.a, boxes.pose_a, boxes.b, boxes.pose_b)) continue;  // not answered in the frame of A
    const PairResult r = depth_of_boxes(boxes.a, boxes.pose_a, boxes.b, boxes.pose_b);
    if (r.outcome != Outcome::penetrating) continue;
    const BoxContact contact = contact_of_boxes({boxes.a, boxes.pose_a, boxes.b, boxes.pose_b});
    CHECK(contact.sole);
    CHECK(contact.sat.penetration == -r.distance && contact.sat.feature == r.feature);
    CHECK(boxes.pose_a * contact.witness.a == r.witness_a && boxes.pose_a.rotation * contact.sat.axis == r.normal);
  }
}

// Edges along each other, or faces: the contact is a segment or a polygon, for others to halve.
void test_wide_contacts_are_left_open() {
  const Shape box = make_box({1, 1, 1});
  Pose beside;
  beside.translation = {1.5, 0.25, 0.125};
  CHECK(depth_of_boxes(box, {}, box, beside).outcome == Outcome::undecided);
  CHECK(!contact_of_boxes({box, {}, box, beside}).sole);
  CHECK(overlap_of_boxes(box, {}, box, beside).outcome == Outcome::penetrating);
}

// Squares of such sines lose their digits, and those of smaller ones are 0.
void test_hardly_turned() {
  const Shape box = make_box({1, 1, 1});
  for (const double angle : {1e-90, 1e-140, 1e-155, 3e-160, 1e-161, 2e-162, 1e-200}) {
    Pose turned;
    turned.rotation = {{{1, -angle, 0}, {angle, 1, 0}, {0, 0, 1}}};
    turned.translation = {0.5, 0.25, 1.75};
    const SatResult sat = contact_of_boxes({box, {}, box, turned}).sat;
    CHECK(sat.penetration == 0.25);
    CHECK(sat.axis == (Vec3{0, 0, 1}));
  }
}

void test_touching_is_left_open() {
  const Shape box = make_box({1, 1, 1});
  Pose beside;
  for (const Vec3 offset : {Vec3{2, 0, 0}, Vec3{2, 2, 0.5}, Vec3{2, 2, 2}}) {
    beside.translation = offset;
    CHECK(overlap_of_boxes(box, {}, box, beside).outcome == Outcome::undecided);
    CHECK(depth_of_boxes(box, {}, box, beside).outcome == Outcome::undecided);
  }
}

}  // namespace

UNIT(box_pair) {
  test_overlap_matches_hulls();
  test_depth_matches_hulls();
  test_either_order_is_the_same_bits();
  test_difference_gives_the_same_bits();
  test_wide_contacts_are_left_open();
  test_hardly_turned();
  test_touching_is_left_open();
}
