// Two boxes on 15 axes, against GJK + EPA on their corners, which share nothing with it.
#include "convex/box_pair.hpp"

#include "base/rounding.hpp"
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

PairResult depth(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  return check_pair(a, pose_a, b, pose_b, Query::depth);
}

PairResult by_gjk(const Boxes& boxes, Query query) {
  return check_pair(boxes.a, boxes.pose_a, boxes.b, boxes.pose_b, query, MethodChoice::gjk);
}

void test_overlap_matches_gjk() {
  testing::Source source(3);
  int overlaps = 0, by_edges = 0;
  for (int round = 0; round < 2000; ++round) {
    const Boxes boxes = random_boxes(source, 0.9);
    const PairResult r = overlap_of_boxes(boxes.a, boxes.pose_a, boxes.b, boxes.pose_b);
    CHECK(r.outcome == by_gjk(boxes, Query::overlap).outcome);
    CHECK((r.feature == Feature::none) == (r.outcome == Outcome::penetrating));
    overlaps += r.outcome == Outcome::penetrating;
    by_edges += r.feature == Feature::edge_edge;
  }
  CHECK(overlaps > 500 && overlaps < 1500);
  CHECK(by_edges > 10);
}

void test_depth_matches_gjk() {
  testing::Source source(5);
  int seen[6] = {};
  for (int round = 0; round < 1000; ++round) {
    const Boxes boxes = random_boxes(source, 0.6);
    const PairResult r = depth(boxes.a, boxes.pose_a, boxes.b, boxes.pose_b);
    const PairResult truth = by_gjk(boxes, Query::depth);
    CHECK(r.outcome == truth.outcome && r.has_distance);
    CHECK((r.method == Method::sat) == (truth.outcome == Outcome::penetrating));
    if (truth.outcome != Outcome::penetrating) continue;
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
    const PairResult ab = depth(boxes.a, boxes.pose_a, boxes.b, boxes.pose_b);
    const PairResult ba = depth(boxes.b, boxes.pose_b, boxes.a, boxes.pose_a);
    CHECK(ab.outcome == ba.outcome);
    CHECK(ab.distance == ba.distance && ab.normal == -ba.normal);
    CHECK(ab.witness_a == ba.witness_b && ab.witness_b == ba.witness_a);
    CHECK(ab.index_a == ba.index_b && ab.index_b == ba.index_a);
  }
}

// Hulls of the corners, in place and placed by another pose: the same boxes.
void test_hulls_that_are_boxes() {
  testing::Source source(9);
  const auto corners_of = [](const Shape& box, const Pose& pose) {
    std::vector<Vec3> corners = box.polytope.vertices;
    for (Vec3& p : corners) p = pose * p;
    return corners;
  };
  int overlaps = 0;
  for (int round = 0; round < 500; ++round) {
    const Boxes boxes = random_boxes(source, 0.7);
    const Pose moved = round % 2 == 0 ? Pose{} : source.pose(0.1);
    const Shape a = make_hull(corners_of(boxes.a, boxes.pose_a)), b = make_hull(corners_of(boxes.b, boxes.pose_b));
    const PairResult truth = by_gjk(boxes, Query::depth), overlap = check_pair(a, moved, b, moved, Query::overlap);
    CHECK(a.is_box() && b.is_box());
    CHECK(overlap.outcome == truth.outcome && overlap.method == Method::sat);
    for (const PairResult& r : {depth(a, moved, b, moved), depth(a, {}, boxes.b, boxes.pose_b)}) {
      CHECK(r.outcome == truth.outcome && std::fabs(r.distance - truth.distance) <= kNear);
      if (truth.outcome != Outcome::penetrating) continue;
      CHECK(r.method == Method::sat && r.axes_tested == 15);
      CHECK(norm(r.witness_b - r.witness_a - r.normal * r.distance) <= kNear);
    }
    const PairResult placed = depth(a, moved, b, moved), same = check_pair(a, moved, b, moved, Query::depth, MethodChoice::gjk);
    CHECK(norm(placed.normal - same.normal) <= 1e-9 || std::fabs(truth.distance) < 1e-6);
    if (placed.feature != Feature::edge_edge) CHECK(norm(placed.witness_a - same.witness_a) <= 1e-9);
    overlaps += truth.outcome == Outcome::penetrating;
  }
  CHECK(overlaps > 100);
}

// Exact signs decide what is flush, in hulls as in boxes.
void test_flush_hulls() {
  const auto block = [](Vec3 low, Vec3 high) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    return make_hull(corners);
  };
  const Shape a = block({0, 0, 0}, {0.1, 0.7, 0.9});
  for (const double start : {std::nextafter(0.1, 0.0), 0.1, std::nextafter(0.1, 1.0)}) {
    const Outcome expected = start > 0.1 ? Outcome::separated : start < 0.1 ? Outcome::penetrating : Outcome::touching;
    const Shape b = block({start, 0.3, 0.2}, {1.3, 0.8, 1.1});
    for (const Query query : {Query::overlap, Query::depth}) CHECK(check_pair(a, {}, b, {}, query).outcome == expected);
    CHECK(depth(a, {}, b, {}).distance == start - 0.1);
  }
  // The figure is the difference of two coordinates.
  CHECK(depth(a, {}, block({0.07, 0.3, 0.2}, {1.3, 0.8, 1.1}), {}).distance == 0.07 - 0.1);
}

// Edges along each other, or faces: the contact is a segment or a polygon, and the points lie in its middle.
void test_wide_contacts() {
  const Shape box = make_box({1, 1, 1});
  Pose beside;
  beside.translation = {1.5, 0.25, 0.125};
  CHECK(!contact_of_boxes({box, {}, box, beside}, {}, beside).sole);
  const PairResult r = depth(box, {}, box, beside);
  CHECK(r.method == Method::sat && r.distance == -0.5);
  CHECK(r.witness_a == (Vec3{1, 0.125, 0.0625}) && r.witness_b == (Vec3{0.5, 0.125, 0.0625}));
}

// Squares of such sines lose their digits, and those of smaller ones are 0.
void test_hardly_turned() {
  const Shape box = make_box({1, 1, 1});
  for (const double angle : {1e-90, 1e-140, 1e-155, 3e-160, 1e-161, 2e-162, 1e-200}) {
    Pose turned;
    turned.rotation = {{{1, -angle, 0}, {angle, 1, 0}, {0, 0, 1}}};
    turned.translation = {0.5, 0.25, 1.75};
    const SatResult sat = contact_of_boxes({box, {}, box, turned}, {}, turned).sat;
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
    CHECK(depth(box, {}, box, beside).outcome == Outcome::touching);
  }
}

}  // namespace

UNIT(box_pair) {
  test_overlap_matches_gjk();
  test_depth_matches_gjk();
  test_either_order_is_the_same_bits();
  test_hulls_that_are_boxes();
  test_flush_hulls();
  test_wide_contacts();
  test_hardly_turned();
  test_touching_is_left_open();
}
