// Boxes and pins; what Python tests against set operations runs here under the sanitizers.
#include "overlap/overlap_components.hpp"

#include <cmath>

#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;

namespace {

constexpr std::size_t kPlenty = 1'000'000;

Surface box(Vec3 low, Vec3 high) { return make_surface(testing::box(low, high), true); }

void corner_of_boxes() {
  const Surface low = box({0, 0, 0}, {2, 2, 2}), high = box({1, 0.5, 0.25}, {3, 3, 3});
  const OverlapComponents overlap = overlap_components(low, high, kPlenty);
  CHECK(overlap.resolved && overlap.components.size() == 1);
  const OverlapComponent& common = overlap.components[0];
  CHECK((common.bounds.min == Vec3{1, 0.5, 0.25}) && (common.bounds.max == Vec3{2, 2, 2}));
  CHECK(common.curves == 1 && common.curve_length == 2 * (1 + 1.5 + 1.75));
  CHECK(common.a_through_b == false && common.b_through_a == false);
}

void pin_through_a_plate() {
  const Surface pin = box({1, 1, -1}, {2, 2, 2}), plate = box({0, 0, 0}, {3, 3, 1});
  const OverlapComponents overlap = overlap_components(pin, plate, kPlenty);
  const OverlapComponents mirrored = overlap_components(plate, pin, kPlenty);
  CHECK(overlap.components.size() == 1 && overlap.components[0].curves == 2);
  CHECK(overlap.components[0].a_through_b == true && overlap.components[0].b_through_a == false);
  CHECK(mirrored.components[0].a_through_b == false && mirrored.components[0].b_through_a == true);
  CHECK(passes_through(pin, plate, kPlenty) == true && passes_through(plate, pin, kPlenty) == true);
}

// The faces that they cut from the plate have holes, and one lies in the hole of another.
void post_with_a_rod_in_its_cavity() {
  const auto column = [](double low, double high, double ends) {
    return testing::box({low, low, -ends}, {high, high, 1 + ends});
  };
  Mesh post = column(1, 5, 3);
  testing::append(post, testing::reversed(column(2, 4, 2)));
  testing::append(post, column(2.5, 3.5, 1));
  const OverlapComponents overlap = overlap_components(make_surface(post, true), box({0, 0, 0}, {9, 9, 1}), kPlenty);
  CHECK(overlap.resolved && overlap.components.size() == 2);
  CHECK(std::fabs(overlap.components[0].volume - 12) < 1e-12 && overlap.components[0].curves == 4);
  CHECK(std::fabs(overlap.components[1].volume - 1) < 1e-12 && overlap.components[1].curves == 2);
  for (const OverlapComponent& component : overlap.components) CHECK(component.a_through_b == true);
}

// A box in a box that encloses it, but for a cave that reaches into neither.
void caves() {
  Mesh hollow = testing::box({0, 0, 0}, {8, 8, 8});
  testing::append(hollow, testing::reversed(testing::box({3, 3, 3}, {5, 5, 5})));
  const Surface block = box({1, 1, 1}, {7, 7, 7});
  const OverlapComponents overlap = overlap_components(make_surface(hollow, true), block, kPlenty);
  CHECK(overlap.resolved && overlap.components.size() == 1 && overlap.components[0].triangles == 24);
  testing::append(hollow, testing::box({3.5, 3.5, 3.5}, {4.5, 4.5, 4.5}));
  CHECK(overlap_components(make_surface(hollow, true), block, kPlenty).components.size() == 2);
}

// Two boxes that cross count as one solid, which meets itself within the block.
void what_is_not_resolved() {
  Mesh crossed = testing::box({0, 0, 0}, {4, 4, 4});
  testing::append(crossed, testing::box({2, 2, 2}, {6, 6, 6}));
  const Surface a = make_surface(crossed, true), block = box({1, 1, 1}, {5, 5, 5});
  const OverlapComponents described = overlap_components(a, block, kPlenty);
  CHECK(!described.resolved && !described.components.empty());
  const OverlapComponents left_out = overlap_components(a, block, kPlenty, Unresolved::left_out);
  CHECK(!left_out.resolved && left_out.components.empty());
}

void spheres_cross_in_one_curve() {
  Mesh other = testing::uv_sphere(24);
  for (Vec3& p : other.vertices) p = {p.z + 0.7, p.x + 0.1, p.y + 0.2};
  const Surface a = make_surface(testing::uv_sphere(24), true), b = make_surface(other, true);
  const OverlapComponents overlap = overlap_components(a, b, kPlenty);
  CHECK(overlap.resolved && overlap.components.size() == 1 && overlap.components[0].curves == 1);
  CHECK(overlap.within_limits);
  const OverlapComponents too_many = overlap_components(a, b, 3);
  CHECK(!too_many.resolved && !too_many.within_limits);
  for (const std::uint64_t steps : {100'000u, 2'000'000u}) {  // among the contacts, and among the faces
    Budget few = Budget::that_stops(steps, {});
    const OverlapComponents spent = overlap_components(a, b, kPlenty, Unresolved::described, &few);
    CHECK(!spent.resolved && !spent.within_limits && spent.components.empty());
  }
}

}  // namespace

UNIT(overlap_components) {
  corner_of_boxes();
  pin_through_a_plate();
  post_with_a_rod_in_its_cavity();
  caves();
  what_is_not_resolved();
  spheres_cross_in_one_curve();
}
