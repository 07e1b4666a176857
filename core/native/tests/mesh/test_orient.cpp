// Repairs of winding, against boxes whose nesting is known by their corners.
#include "mesh/facing.hpp"
#include "mesh/orient.hpp"

#include <algorithm>
#include <random>

#include "mesh/surface.hpp"
#include "mesh/topology.hpp"
#include "mesh_pair/mesh_pair.hpp"
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
    const Mesh oriented = orient(all);
    const Facing found = facing_of(oriented);
    Mesh result = oriented;
    turn(result, found.inward);
    const Topology topology = measure_topology(result);
    CHECK(topology.solid && topology.oriented && topology.triangles == all.triangles.size());
    CHECK(topology.volume > 0);
    int around = 0;  // the winding number of the boxes around
    int facing = 1;  // -1: the boxes around are turned
    std::size_t doubtful = 0;
    for (std::size_t k = 0; k < stack.boxes.size(); ++k) {
      if (stack.depth[k] == 0) around = 0, facing = 1;
      // A box with mixed winding faces outward, as most of its triangles do. A box in material turns with the boxes
      // around it; a box in nothing, or in the cavity of another one, faces outward.
      const int wound = facing * (stack.wound[k] == Wound::inward ? -1 : 1);
      const bool turns = around == 0 && wound < 0;
      if (turns) facing = -facing;
      const bool outward = turns || wound > 0;
      CHECK((volume_of(result, stack.boxes[k]) > 0) == outward);
      // It faced outward, and is a cavity only because the boxes around it were turned.
      if (stack.wound[k] != Wound::inward && !outward) ++doubtful;
      around += outward ? 1 : -1;
    }
    CHECK(found.doubtful.size() == doubtful);
    CHECK(make_surface(oriented, false).solid == found.doubtful.empty());
    // Again, nothing changes.
    const Mesh again = orient(result);
    CHECK(again.triangles == result.triangles && again.vertices == result.vertices);
    CHECK(orient(oriented).triangles == oriented.triangles);
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
    Mesh oriented = orient(round % 2 == 0 ? outward : reversed(outward));
    turn(oriented, facing_of(oriented).inward);
    const Surface solid = make_surface(oriented, true);
    for (int x = 0; x < 5; ++x)
      for (int y = 0; y < 5; ++y)
        for (int z = 0; z < 5; ++z) CHECK(winding_number(solid, {x + 0.5, y + 0.5, z + 0.5}) == (cells(x, y, z) ? 1 : 0));
  }
}

// A room that faces inward, with a table that faces outward: in the table nothing is known, elsewhere all is.
void rooms() {
  const Vec3 low{2, 2, 0.5}, high{4, 4, 1.5};
  Mesh room = reversed(box({0, 0, 0}, {10, 10, 4}));
  append(room, box(low, high));
  const Surface surface = make_surface(orient(room), false);
  CHECK(!surface.solid);
  std::mt19937 generator(31);
  std::uniform_real_distribution<double> x(-1, 11), z(-1, 5), size(0.1, 3);
  for (int round = 0; round < rounds(400); ++round) {
    const Vec3 from{x(generator), x(generator), z(generator)};
    const Vec3 to = from + Vec3{size(generator), size(generator), size(generator)};
    const auto lies_in = [&](Vec3 least, Vec3 most) {
      return std::min({from.x - least.x, from.y - least.y, from.z - least.z, most.x - to.x, most.y - to.y, most.z - to.z}) > 0;
    };
    const auto is_clear_of = [&](Vec3 least, Vec3 most) {
      return std::max({from.x - most.x, from.y - most.y, from.z - most.z, least.x - to.x, least.y - to.y, least.z - to.z}) > 0;
    };
    const MeshRelation found = mesh_relation(surface, make_surface(box(from, to), true));
    if (lies_in(low, high)) {
      CHECK(found.hole && found.hole->doubtful && !found.proven);
    } else {
      const Relation expected = is_clear_of({0, 0, 0}, {10, 10, 4})                            ? Relation::separated
                                : lies_in({0, 0, 0}, {10, 10, 4}) && is_clear_of(low, high) ? Relation::contains
                                                                                               : Relation::penetrating;
      const bool around_the_table = lies_in({0, 0, 0}, {10, 10, 4}) && from.x < low.x && from.y < low.y && from.z < low.z &&
                                    high.x < to.x && high.y < to.y && high.z < to.z;
      if (!around_the_table) CHECK(found.proven && !found.hole && found.relation == expected);
    }
  }
}

// Two boxes with a common face are one solid, although neither surface ends there.
void compounds() {
  Mesh table = box({2, 2, 0.5}, {3, 4, 1.5}), room = reversed(box({0, 0, 0}, {10, 10, 4}));
  append(table, box({3, 2, 0.5}, {4, 4, 1.5}));
  append(room, table);
  CHECK(facing_of(orient(room)).doubtful.size() == 1);
  append(room, box({20, 0, 0}, {40, 20, 20}));  // the larger solid: the room turns alone
  CHECK(facing_of(orient(room)).doubtful.size() == 1);
  // Inside out across the face of a larger solid: nothing of either is empty.
  Mesh across = box({2.5, 0, -5}, {40, 20, 5});
  append(across, reversed(table));
  const Surface solid = make_surface(orient(across), false);
  CHECK(solid.solid);
  for (const double x : {2.25, 2.75, 3.5, 4.5}) CHECK(winding_number(solid, {x, 3, 1.125}).value_or(0) > 0);
}

// A bolt through the wall of a tank, or of both of its walls, fills none of the cavity but its own place.
void bolts() {
  for (int round = 0; round < 16; ++round) {
    const bool tank_inward = round & 1, wall_inward = round & 2, bolt_inward = round & 4, outside = round & 8;
    if (bolt_inward && !outside) continue;  // as in crossed_walls()
    const auto wound = [](const Mesh& mesh, bool inward) { return inward ? reversed(mesh) : mesh; };
    Mesh all = box({20, 0, 0}, {60, 40, 40});  // so that most of the volume faces outward
    append(all, wound(box({-5, -5, -5}, {5, 5, 5}), tank_inward));
    append(all, wound(box({-4, -4, -4}, {4, 4, 4}), wall_inward));
    append(all, wound(box({3, -1, -1}, {outside ? 7.0 : 4.5, 1, 1}), bolt_inward));
    const Surface solid = make_surface(orient(all), false);
    const auto at = [&](Vec3 point) { return winding_number(solid, point).value_or(0); };
    // What faces outward within a tank that faces inward may be solid or not.
    CHECK(solid.solid == !(tank_inward && !(wall_inward && outside)));
    if (!solid.solid) continue;
    CHECK(at({-4.5, 0.3, 0.1}) != 0 && at({4.25, 0.3, 0.1}) != 0 && at({3.5, 0.3, 0.1}) != 0);
    CHECK((at({0, 0.3, 0.1}) != 0) == (tank_inward == wall_inward));
    CHECK((at({6, 0.3, 0.1}) != 0) == outside);
  }
}

// Two hollow solids of which the walls cross: what lies in both walls may be empty or not, all else is known.
void crossed_walls() {
  Mesh all = box({0, 0, 0}, {10, 10, 10});
  append(all, reversed(box({1, 1, 1}, {9, 9, 9})));
  append(all, box({5, 2, 2}, {20, 8, 8}));
  append(all, reversed(box({6, 3, 3}, {19, 7, 7})));
  const Mesh oriented = orient(all);
  CHECK(oriented.triangles == weld(all).triangles && facing_of(oriented).inward.empty());
  CHECK(facing_of(oriented).doubtful.size() == 2);
  const Surface surface = make_surface(oriented, false);
  const auto relation = [&](Vec3 low, double size) {
    return mesh_relation(surface, make_surface(box(low, low + Vec3{size, size, size}), true));
  };
  for (const Vec3 at : {Vec3{2, 2, 2}, Vec3{7, 4, 4}, Vec3{12, 4, 4}}) CHECK(!relation(at, 0.5).proven);
  const MeshRelation in_outer = relation({0.25, 4, 4}, 0.5), beyond = relation({25, 4, 4}, 0.5);
  CHECK(in_outer.proven && in_outer.relation == Relation::contains);
  CHECK(beyond.proven && beyond.relation == Relation::separated);
}

// Half of a cavity is filled. What fills it has corners in common with the wall, and crosses the wall at others, as if
// rounded: the other half stays empty.
void half_filled() {
  Mesh all = box({-5, -5, -5}, {5, 5, 5});
  append(all, reversed(box({-4, -4, -4}, {4, 4, 4})));
  Mesh fill = box({-4, -4, -4}, {4, 4, 0});
  for (Vec3& p : fill.vertices) {
    if (p.z == 0) p.x *= 1 + 1e-12, p.y *= 1 - 1e-12;
  }
  append(all, fill);
  const Surface solid = make_surface(orient(all), false);
  CHECK(solid.solid);
  CHECK(winding_number(solid, {0.3, 0.1, 2}) == 0 && winding_number(solid, {0.3, 0.1, -2}) == 1);
}

// All faces of a box lie within faces of the boxes beside it, which do not say what lies around it.
void between_others() {
  const Aabb boxes[] = {{{0, 0, 0}, {9, 9, 9}}, {{2, 2, 2}, {4, 4, 4}}, {{4, 1, 2}, {5, 4, 4}}, {{1, 2, 2}, {2, 5, 4}},
                        {{2, 4, 2}, {5, 5, 4}}, {{1, 1, 2}, {4, 2, 4}}, {{1, 1, 4}, {5, 5, 5}}, {{1, 1, 1}, {5, 5, 2}}};
  Mesh all;
  double volume = 0;
  for (const Aabb& b : boxes) {
    append(all, reversed(box(b.min, b.max)));
    const Vec3 size = b.max - b.min;
    volume += size.x * size.y * size.z;
  }
  CHECK(measure_topology(orient(all)).volume == volume);
}

// A Moebius strip cannot be wound consistently, and is turned as a whole, if at all.
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
  const Mesh result = orient(strip);
  CHECK(result.triangles == weld(strip).triangles || result.triangles == weld(reversed(strip)).triangles);
  CHECK(!measure_topology(result).oriented);
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
  rooms();
  compounds();
  bolts();
  crossed_walls();
  half_filled();
  between_others();
  one_sided();
  copies();
}
