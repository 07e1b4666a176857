// How deep surfaces reach into solids, of shapes for which that is known.
#include "mesh_pair/reach.hpp"

#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

std::optional<bool> reaches(const Mesh& surface_of, const Surface& solid, double length, std::uint64_t work = 1'000'000'000) {
  Budget budget = Budget::that_stops(work);
  return reaches_deeper(surface_of, solid, length, budget);
}

void check_reach(const Mesh& surface_of, const Mesh& solid, double depth) {
  const Surface in = make_surface(solid, true);
  CHECK(reaches(surface_of, in, depth * (1 - 1e-3)) == true);
  CHECK(reaches(surface_of, in, depth * (1 + 1e-3)) == false);
}

void reach_of_boxes() {
  const Mesh block = box({0, 0, 0}, {8, 8, 8});
  check_reach(box({-1, 3, 3}, {1, 4, 4}), block, 1);       // a peg, at its end
  check_reach(box({-1, 3.5, 3}, {9, 3.5625, 4}), block, 3.5625);  // a pin, in the middle of its sides
  check_reach(box({-1, 3, -1}, {2, 3.0625, 9}), block, 2);     // a blade across, along its edge
  check_reach(block, box({-1, 3, 3}, {1, 4, 4}), 0.5);     // the face in which the peg lies
}

void what_is_outside_reaches_nowhere() {
  const Surface block = make_surface(box({0, 0, 0}, {1, 1, 1}), true);
  CHECK(reaches(box({2, 0, 0}, {3, 1, 1}), block, 1e-6) == false);
  CHECK(reaches(box({1, 0, 0}, {2, 1, 1}), block, 1e-6) == false);
}

void a_cavity_has_no_depth() {
  Mesh shell = box({0, 0, 0}, {8, 8, 8});
  append(shell, reversed(box({1, 1, 1}, {7, 7, 7})));
  const Surface solid = make_surface(shell, true);
  CHECK(reaches(box({3, 3, 3}, {4, 4, 4}), solid, 1e-6) == false);
  check_reach(box({-1, 3, 3}, {4, 4, 4}), shell, 0.5);
}

void too_little_work_is_no_answer() {
  const Surface block = make_surface(box({0, 0, 0}, {8, 8, 8}), true);
  CHECK(!reaches(box({-1, 3.5, 3}, {9, 3.5625, 4}), block, 3.5, 1000));
}

}  // namespace

UNIT(reach) {
  reach_of_boxes();
  what_is_outside_reaches_nowhere();
  a_cavity_has_no_depth();
  too_little_work_is_no_answer();
}
