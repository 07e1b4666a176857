// Topology numbers and repairs of boxes that are put together and broken in known ways.
#include "mesh/facing.hpp"
#include "mesh/orient.hpp"
#include "mesh/surface.hpp"
#include "mesh/topology.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "mesh/transform.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

const Mesh unit = box({0, 0, 0}, {1, 1, 1});

Mesh soup(const Mesh& mesh) {
  Mesh result;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    for (const std::uint32_t v : t) result.vertices.push_back(mesh.vertices[v]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

void counts_of_a_box() {
  const Topology t = measure_topology(soup(unit));
  CHECK(t.vertices == 36 && t.triangles == 12 && t.components == 1);
  CHECK(t.boundary_edges == 0 && t.nonmanifold_edges == 0 && t.misoriented_edges == 0);
  CHECK(t.closed && t.manifold && t.oriented && t.solid);
  CHECK(t.volume == 1);
}

void broken_boxes() {
  Mesh open = unit;
  open.triangles.pop_back();
  Topology t = measure_topology(open);
  CHECK(!t.closed && !t.manifold && t.oriented && !t.solid && t.volume == 0);
  CHECK(t.boundary_edges == 3);

  Mesh mixed = unit;
  std::swap(mixed.triangles[3][0], mixed.triangles[3][1]);
  t = measure_topology(mixed);
  CHECK(t.closed && t.manifold && !t.oriented && !t.solid && t.misoriented_edges == 3);
  CHECK(measure_topology(orient(mixed)).volume == 1);
  CHECK(measure_topology(orient(reversed(mixed))).volume == 1);

  Mesh doubled = unit;
  append(doubled, reversed(unit));
  t = measure_topology(doubled);
  CHECK(t.closed && !t.manifold && t.oriented && t.volume == 0 && !t.solid);
  CHECK(t.duplicate_triangles == 12 && t.nonmanifold_edges == 18);

  Mesh flat{{{0, 0, 0.1}, {1, 0, 0.1}, {0.3, 0.7, 0.1}, {0.9, 0.8, 0.1}}, {{0, 1, 2}, {1, 3, 2}, {0, 3, 1}, {0, 2, 3}}};
  t = measure_topology(flat);
  CHECK(t.closed && t.oriented && t.volume == 0 && !t.solid);

  Mesh repeated = unit;
  repeated.triangles.push_back({unit.triangles[5][1], unit.triangles[5][0], unit.triangles[5][2]});
  CHECK(!measure_topology(repeated).closed);
  CHECK(orient(repeated).triangles == unit.triangles);

  Mesh degenerate = unit;
  degenerate.triangles.push_back({0, 0, 1});
  t = measure_topology(degenerate);
  CHECK(t.degenerate_triangles == 1 && t.solid);
}

void orienting_counts_its_steps() {
  Mesh boxes = box({10, 0, 0}, {20, 10, 10});  // beside boxes that face inward, each of which crosses all others
  for (int i = 0; i < 40; ++i) append(boxes, reversed(box(Vec3{1, 1, 1} * (0.01 * i), Vec3{1, 1, 1} * (0.01 * i + 1))));
  Budget few = Budget::that_stops(1000), enough = Budget::that_stops(kMostSteps);
  const auto stops = [&] {
    try {
      orient(boxes, &few);
    } catch (const BudgetSpent&) {
      return true;
    }
    return false;
  };
  CHECK(stops());
  CHECK(orient(boxes, &enough).triangles == orient(boxes).triangles);
  CHECK(enough.spent() > 1000 && enough.left() > 0);
}

// The first other shell has each bubble inside: the boxes of the rest are not looked at.
void bubbles_cost_what_is_looked_at() {
  const auto steps = [](int count) {
    Mesh foam = box({0, 0, 0}, Vec3{1, 1, 1} * (count + 1.0));
    for (int i = 0; i < count; ++i) append(foam, reversed(box(Vec3{1, 1, 1} * (i + 0.7), Vec3{1, 1, 1} * (i + 1.3))));
    Budget budget = Budget::that_stops(kMostSteps);
    orient(foam, &budget);
    return budget.spent();
  };
  const int count = kSanitized ? 300 : 3000;  // sanitizers need no long series to see each read
  CHECK(steps(2 * count) < 3 * steps(count));
}

void orientation_of_shells() {
  const Mesh outer = box({0, 0, 0}, {10, 10, 10}), inner = box({4, 4, 4}, {6, 6, 6});
  CHECK(measure_topology(orient(reversed(unit))).volume == 1);

  Mesh hollow = outer;
  append(hollow, reversed(inner));
  CHECK(measure_topology(orient(hollow)).volume == 1000 - 8);
  // A solid that is inside out, or a room with a box in it.
  CHECK(orient(reversed(hollow)).triangles == reversed(hollow).triangles);
  Mesh outward = reversed(hollow);
  turn(outward, facing_of(outward).inward);
  CHECK(measure_topology(outward).volume == 1000 - 8);

  Mesh both_outward = outer;
  append(both_outward, inner);
  CHECK(measure_topology(orient(both_outward)).volume == 1000 + 8);

  Mesh apart = outer;
  append(apart, reversed(box({20, 0, 0}, {21, 1, 1})));
  CHECK(measure_topology(orient(apart)).volume == 1001);

  Mesh edge_sharing = unit;
  append(edge_sharing, reversed(box({1, 1, 0}, {2, 2, 1})));
  CHECK(measure_topology(edge_sharing).nonmanifold_edges == 1);
  CHECK(measure_topology(edge_sharing).components == 1);
  CHECK(measure_topology(orient(edge_sharing)).volume == 2);
}

// A box in the notch of a concave body: inside its box, yet outside of it.
void inside_out_box_in_a_notch() {
  Mesh mesh = box({0, 0, 0}, {3, 1, 1});
  append(mesh, box({0, 1.5, 0}, {3, 3, 1}));
  append(mesh, reversed(box({1, 1.125, 0.25}, {2, 1.375, 0.75})));
  CHECK(measure_topology(orient(mesh)).volume == 3 + 4.5 + 0.125);
}

// It has no outside: it may be turned as a whole.
void moebius_band_stays() {
  Mesh band;
  const std::uint32_t n = 8;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double around = 6.283185307179586 * i / n, turn = around / 2;
    for (const double r : {-0.3, 0.3}) {
      band.vertices.push_back({(1 + r * std::cos(turn)) * std::cos(around),
                               (1 + r * std::cos(turn)) * std::sin(around), r * std::sin(turn)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const std::uint32_t c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    band.triangles.push_back({a, b, c});
    band.triangles.push_back({b, d, c});
  }
  const Mesh result = orient(band);
  CHECK(result.triangles == weld(band).triangles || result.triangles == weld(reversed(band)).triangles);
}

void components_and_transforms() {
  Mesh two = unit;
  append(two, box({5, 5, 5}, {6, 6, 6}));
  const auto parts = split_components(two);
  CHECK(parts.size() == 2 && parts[1].vertices.size() == 8 && parts[1].triangles.size() == 12);

  // A wall of a cavity, also if it lies in the surface around it; and what is none: it crosses it, or lies outside.
  const auto count_with = [](const Mesh& inner) {
    Mesh boxes = box({0, 0, 0}, {8, 8, 8});
    append(boxes, reversed(inner));
    return split_components(boxes).size();
  };
  CHECK(count_with(box({2, 2, 2}, {6, 6, 6})) == 1);
  CHECK(count_with(box({2, 2, 2}, {6, 6, 9})) == 2);
  CHECK(count_with(box({2, 2, 2}, {6, 6, 8})) == 1);
  CHECK(count_with(box({9, 2, 2}, {12, 6, 6})) == 2);
  // What touches the wall from within does not matter, nor what crosses it.
  Mesh held = box({2, 2, 2}, {6, 6, 6});
  append(held, reversed(box({3, 3, 2}, {4, 4, 4})));
  CHECK(count_with(held) == 2);
  append(held, reversed(box({5, 5, 5}, {7, 5.5, 5.5})));
  CHECK(count_with(held) == 3);
  // A wall in two solids that cross belongs to one of them.
  Mesh crossing = box({0, 0, 0}, {8, 8, 8});
  append(crossing, box({1, 1, 1}, {7, 7, 9}));
  append(crossing, reversed(box({3, 3, 3}, {4, 4, 4})));
  CHECK(split_components(crossing).size() == 2);
  // Each wall belongs to its own solid, also if the solids cross, with walls that cross or lie in each other.
  for (const Mesh& second : {box({6, 3, 3}, {19, 7, 7}), box({6, 4, 4}, {8, 6, 6})}) {
    Mesh tanks = box({0, 0, 0}, {10, 10, 10});
    append(tanks, reversed(box({1, 1, 1}, {9, 9, 9})));
    append(tanks, box({5, 2, 2}, {20, 8, 8}));
    append(tanks, reversed(second));
    const std::vector<Mesh> split = split_components(tanks);
    CHECK(split.size() == 2);
    for (const Mesh& tank : split) CHECK(tank.triangles.size() == 24 && make_surface(tank, false).solid);
  }

  const Mesh mirrored = transform(unit, {-2, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  CHECK(measure_topology(mirrored).volume == 2);
  const Mesh moved = translate(unit, {0.1, 0, 0});
  CHECK(moved.vertices[1].x == 1.1);
  for (const std::array<double, 16>& bad :
       {std::array<double, 16>{1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1},
        std::array<double, 16>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1}}) {
    bool refused = false;
    try {
      transform(unit, bad);
    } catch (const std::invalid_argument&) {
      refused = true;
    }
    CHECK(refused);
  }
  for (const double entry : {static_cast<double>(NAN), static_cast<double>(INFINITY)}) {  // a product that overflowed
    bool overflowed = false;
    try {
      transform(unit, {entry, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    } catch (const std::overflow_error&) {
      overflowed = true;
    }
    CHECK(overflowed);
  }
}

void sorting_forgets_the_order() {
  Mesh shuffled = unit;
  std::reverse(shuffled.vertices.begin(), shuffled.vertices.end());
  const auto last = static_cast<std::uint32_t>(unit.vertices.size() - 1);
  std::reverse(shuffled.triangles.begin(), shuffled.triangles.end());
  for (Triangle& t : shuffled.triangles) t = {last - t[1], last - t[2], last - t[0]};
  const Mesh one = sort(unit), other = sort(shuffled);
  CHECK(one.vertices == other.vertices && one.triangles == other.triangles);
  CHECK(measure_topology(one).volume == measure_topology(unit).volume);
  const Mesh flipped = sort(reversed(unit));
  CHECK(flipped.vertices == one.vertices && flipped.triangles != one.triangles);
}

void a_million_triangles() {
  const Mesh sphere = uv_sphere(500);
  const auto start = std::chrono::steady_clock::now();
  const Topology t = measure_topology(sphere);
  const auto middle = std::chrono::steady_clock::now();
  const Mesh turned = orient(reversed(sphere));
  const auto end = std::chrono::steady_clock::now();
  const Mesh sorted = sort(sphere);
  const auto sorted_at = std::chrono::steady_clock::now();
  std::printf("%zu triangles: topology %.3f s, orient %.3f s, sort %.3f s\n", sphere.triangles.size(),
              std::chrono::duration<double>(middle - start).count(),
              std::chrono::duration<double>(end - middle).count(),
              std::chrono::duration<double>(sorted_at - end).count());
  CHECK(sort(sorted).triangles == sorted.triangles);
  CHECK(t.solid && t.manifold && t.volume > 4.18 && t.volume < 4.19);
  CHECK(turned.triangles == sphere.triangles);
}

}  // namespace

UNIT(topology) {
  counts_of_a_box();
  broken_boxes();
  orienting_counts_its_steps();
  bubbles_cost_what_is_looked_at();
  orientation_of_shells();
  inside_out_box_in_a_notch();
  moebius_band_stays();
  components_and_transforms();
  sorting_forgets_the_order();
  a_million_triangles();
}
