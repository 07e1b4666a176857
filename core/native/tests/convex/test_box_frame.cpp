// Which hulls are boxes, and how far their corners are from those of the frame.
#include "convex/box_frame.hpp"

#include "base/rounding.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

std::vector<Vec3> corners_of(Vec3 half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
  return corners;
}

void test_placed_boxes() {
  testing::Source source(4);
  for (int round = 0; round < 300; ++round) {
    const double thin = round % 3 == 0 ? 1e-4 : 1;
    const Vec3 half{source.uniform(0.1, 1) * thin, source.uniform(0.1, 1), source.uniform(0.1, 1)};
    const Pose pose = source.pose(round % 2 == 0 ? 1 : 20);
    std::vector<Vec3> corners = corners_of(half);
    for (Vec3& p : corners) p = pose * p;
    const auto box = find_box(corners);
    if (!CHECK(box)) continue;
    double off = 0;
    for (Vec3 p : corners_of(box->half)) {
      double nearest = INFINITY;
      for (Vec3 q : corners) nearest = std::fmin(nearest, norm(box->rotation * p + box->centre - q));
      off = std::fmax(off, nearest);
    }
    CHECK(off <= box->error && box->error <= 1e-12);
    CHECK(dot(cross(box->rotation.row[0], box->rotation.row[1]), box->rotation.row[2]) > 0);  // right-handed
    std::swap(corners[0], corners[5]);
    CHECK(find_box(corners)->rotation == box->rotation);
  }
}

void test_aligned_boxes_are_exact() {
  const auto box = find_box(corners_of({3, 1, 2}));
  if (!CHECK(box)) return;
  CHECK(box->half == (Vec3{1, 2, 3}) && box->centre == Vec3{});
  for (Vec3 row : box->rotation.row) CHECK(norm_squared(row) == 1 && max_abs(row) == 1);
}

void test_what_is_no_box() {
  for (const Vec3 shift : {Vec3{0.5, 0, 0}, Vec3{0, 1e-9, 0}, Vec3{0, 0, 1e-11}}) {
    std::vector<Vec3> sheared = corners_of({1, 2, 3}), frustum = sheared, bent = sheared;
    for (int i : {4, 5, 6, 7}) sheared[i] = sheared[i] + Vec3{shift.x + shift.y + shift.z, 0, 0};
    for (int i : {4, 5, 6, 7}) frustum[i].x *= 1 + max_abs(shift);
    bent[7] = bent[7] + shift;
    CHECK(!find_box(sheared) && !find_box(frustum) && !find_box(bent));
  }
  testing::Source source(8);
  for (int round = 0; round < 100; ++round) CHECK(!find_box(source.sphere_points(8)));
  CHECK(!find_box(source.sphere_points(7)));
  CHECK(!find_box(std::vector<Vec3>(8)));
  std::vector<Vec3> turned = corners_of({1, 1, 2});  // one end by 45 degrees: an antiprism
  for (int i : {4, 5, 6, 7}) turned[i] = {(turned[i].x - turned[i].y) * std::sqrt(0.5), (turned[i].x + turned[i].y) * std::sqrt(0.5), 2};
  CHECK(!find_box(turned));
}

}  // namespace

UNIT(box_frame) {
  test_placed_boxes();
  test_aligned_boxes_are_exact();
  test_what_is_no_box();
}
