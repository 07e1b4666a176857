// Repairs of winding, against boxes whose nesting is known by their corners.
#include "mesh/orient.hpp"

#include <random>

#include "mesh/surface.hpp"
#include "mesh/topology.hpp"
#include "tests/boxes.hpp"
#include "tests/check.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

enum class Wound { outward, inward, mixed };

// Boxes around each other, the outermost first, each strictly within the one before; and a second stack beside them.
struct Stack {
  std::vector<Mesh> boxes;
  std::vector<Wound> wound;
  std::vector<int> depth;  // 0: outermost
};

Mesh some_turned(Mesh mesh, std::mt19937& generator) {
  // Less than half, so that the majority is outward.
  for (unsigned k = 1 + generator() % 5; k > 0; --k) {
    Triangle& t = mesh.triangles[k];
    std::swap(t[1], t[2]);
  }
  return mesh;
}

Stack random_stack(std::mt19937& generator) {
  Stack stack;
  for (int tower = 0; tower < 2; ++tower) {
    const int height = 1 + static_cast<int>(generator() % 3);
    for (int k = 0; k < height; ++k) {
      const Vec3 shift{20.0 * tower, 0, 0}, half{5.0 - k, 5.0 - k, 5.0 - k};
      const auto wound = static_cast<Wound>(generator() % 3);
      const Mesh outward = box(shift - half, shift + half);
      stack.boxes.push_back(wound == Wound::outward ? outward : wound == Wound::inward ? reversed(outward) : some_turned(outward, generator));
      stack.wound.push_back(wound);
      stack.depth.push_back(k);
    }
  }
  return stack;
}

// The signed volume of the triangles of a result whose corners are those of a box.
double volume_of(const Mesh& result, const Mesh& of) {
  Mesh part{result.vertices, {}};
  Aabb bounds;
  for (const Vec3& v : of.vertices) bounds.include(v);
  for (const Triangle& t : result.triangles) {
    bool corners = true;
    for (const std::uint32_t v : t) {
      const Vec3 p = result.vertices[v];
      for (int axis = 0; axis < 3; ++axis) corners = corners && (p[axis] == bounds.min[axis] || p[axis] == bounds.max[axis]);
    }
    if (corners) part.triangles.push_back(t);
  }
  CHECK(part.triangles.size() == of.triangles.size());
  double sum = 0;
  for (const Triangle& t : part.triangles) {
    sum += dot(part.vertices[t[0]], cross(part.vertices[t[1]], part.vertices[t[2]])) / 6;
  }
  return sum;
}

void stacks() {
  std::mt19937 generator(12);
  for (int round = 0; round < rounds(400); ++round) {
    const Stack stack = random_stack(generator);
    Mesh all;
    for (const Mesh& m : stack.boxes) append(all, m);
    const Mesh result = orient(all);
    const Topology topology = measure_topology(result);
    CHECK(topology.solid && topology.oriented && topology.triangles == all.triangles.size());
    CHECK(topology.volume > 0);
    int around = 0;  // the winding number of the boxes around
    int facing = 1;  // -1: the boxes around are turned
    for (std::size_t k = 0; k < stack.boxes.size(); ++k) {
      if (stack.depth[k] == 0) around = 0, facing = 1;
      // A box with mixed winding faces outward, as most of its triangles do. A box in material turns with the boxes
      // around it; a box in nothing, or in the cavity of another one, faces outward.
      const int wound = facing * (stack.wound[k] == Wound::inward ? -1 : 1);
      const bool turns = around == 0 && wound < 0;
      if (turns) facing = -facing;
      const bool outward = turns || wound > 0;
      CHECK((volume_of(result, stack.boxes[k]) > 0) == outward);
      around += outward ? 1 : -1;
    }
    // Again, nothing changes.
    const Mesh again = orient(result);
    CHECK(again.triangles == result.triangles && again.vertices == result.vertices);
  }
}

// Solids of random cells, one in two inside out as a whole: what is inside stays inside, and their caves stay caves,
// also where a cave meets the outer surface along edges.
void caves() {
  std::mt19937 generator(19);
  for (int round = 0; round < rounds(300); ++round) {
    const Cells cells = random_cells(generator, 5, 0.4 + 0.1 * (round % 5));
    const Mesh outward = boundary_of(cells);
    if (outward.triangles.empty()) continue;
    const Surface solid = make_surface(orient(round % 2 == 0 ? outward : reversed(outward)), true);
    for (int x = 0; x < 5; ++x)
      for (int y = 0; y < 5; ++y)
        for (int z = 0; z < 5; ++z) CHECK(winding_number(solid, {x + 0.5, y + 0.5, z + 0.5}) == (cells(x, y, z) ? 1 : 0));
  }
}

// A Moebius strip cannot be wound consistently, and is left as it is.
void one_sided() {
  Mesh strip;
  const std::uint32_t n = 12;
  for (std::uint32_t k = 0; k < n; ++k) {
    const double around = 2 * 3.141592653589793 * k / n, turn = around / 2;
    for (const double s : {-0.25, 0.25}) {
      const double r = 1 + s * std::cos(turn);
      strip.vertices.push_back({r * std::cos(around), r * std::sin(around), s * std::sin(turn)});
    }
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const bool last = k + 1 == n;
    const std::uint32_t p = 2 * k, q = p + 1, r = last ? 1 : p + 2, s = last ? 0 : p + 3;
    strip.triangles.push_back({p, r, s});
    strip.triangles.push_back({p, s, q});
  }
  CHECK(orient(strip).triangles == weld(strip).triangles);
  CHECK(!measure_topology(orient(strip)).oriented);
}

// Copies of triangles go if the surface is closed only without them.
void copies() {
  Mesh cube = box({0, 0, 0}, {1, 1, 1});
  cube.triangles.push_back(cube.triangles[3]);
  const Mesh result = orient(cube);
  CHECK(result.triangles.size() == 12 && measure_topology(result).solid);
  Mesh twice = box({0, 0, 0}, {1, 1, 1});
  append(twice, box({0, 0, 0}, {1, 1, 1}));
  CHECK(orient(twice).triangles.size() == 24);
}

}  // namespace

UNIT(orient) {
  stacks();
  caves();
  one_sided();
  copies();
}
