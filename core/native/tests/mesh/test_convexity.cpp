// The deviation of solids from their hulls, against distances of sampled points of the hulls.
#include "mesh/convexity.hpp"

#include "convex/convex_hull.hpp"
#include "mesh/surface.hpp"
#include "mesh/transform.hpp"
#include "tests/boxes.hpp"
#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

// The largest distance to the solid of sampled points of its hull: a lower bound of the deviation.
double sampled_deviation(const Mesh& mesh, std::mt19937& generator, int samples) {
  const Surface solid = make_surface(mesh, true);
  const Polytope hull = convex_hull(mesh.vertices);
  double worst = 0;
  for (int k = 0; k < samples; ++k) {
    const Vec3 p = random_in_hull(generator, hull.vertices);
    if (winding_number(solid, p).value_or(1) == 0) worst = std::max(worst, nearest_point(solid, p).distance);
  }
  return worst;
}

void unions_of_boxes() {
  std::mt19937 generator(5);
  int convex = 0, bounded = 0;
  for (int round = 0; round < rounds(400); ++round) {
    const WholeBoxes boxes = random_boxes(generator, 1 + round % 3, 4);
    const Mesh mesh = mesh_of(boxes);
    const double defect = convexity_defect(mesh, INFINITY);
    bool fills_its_box = true;
    WholeBox around = boxes[0];
    for (const WholeBox& b : boxes) {
      for (int axis = 0; axis < 3; ++axis) {
        around.low[axis] = std::min(around.low[axis], b.low[axis]);
        around.high[axis] = std::max(around.high[axis], b.high[axis]);
      }
    }
    for (int x = around.low[0]; x < around.high[0]; ++x)
      for (int y = around.low[1]; y < around.high[1]; ++y)
        for (int z = around.low[2]; z < around.high[2]; ++z) fills_its_box = fills_its_box && cell_in(boxes, x, y, z);
    // Walls within the material are no dents, but no proof that there are none either.
    if (defect == 0) CHECK(fills_its_box);
    if (boxes.size() == 1) CHECK(defect == 0 && convexity_defect(mesh, 0) == 0);
    if (!fills_its_box) CHECK(convexity_defect(mesh, 0) == INFINITY);
    convex += defect == 0;
    if (std::isinf(defect)) continue;
    bounded += defect > 0;
    CHECK(defect >= sampled_deviation(mesh, generator, 100));
    if (defect > 0) CHECK(convexity_defect(mesh, defect * 0.999) == INFINITY);
  }
  CHECK(convex > 0 && bounded > 0);
}

// A pit in the middle of a face: the deviation is at least its depth, but for the width of the pit.
void a_dent() {
  const Mesh cube = box({0, 0, 0}, {4, 4, 4});
  for (const double deep : {0.5, 0.01, 1e-9}) {
    Mesh dented = cube;
    dented.triangles.erase(dented.triangles.begin() + 2, dented.triangles.begin() + 4);  // the face z = 4
    dented.vertices.push_back({2, 2, 4 - deep});
    for (const Triangle rim : {Triangle{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}}) dented.triangles.push_back(rim);
    const double defect = convexity_defect(dented, INFINITY);
    CHECK(convexity_defect(cube, INFINITY) == 0);
    // The middle of the face is `deep` above the pit's point; beside it the pit is a pyramid of half width 2.
    CHECK(defect >= deep / std::sqrt(1 + deep * deep / 4) && std::isfinite(defect));
    CHECK(convexity_defect(dented, 0) == INFINITY);
  }
}

void random_hulls() {
  Source source(9);
  for (int round = 0; round < rounds(200); ++round) {
    const Polytope hull = convex_hull(source.sphere_points(30));
    CHECK(convexity_defect({hull.vertices, hull.triangles}, 0) == 0);
  }
}

// Every edge bends outward, and the middle is below all planes; but the surface winds about the axis twice.
void a_star() {
  Mesh star{{{0, 0, 4}, {0, 0, -4}, {4, 0, 0}, {1, 4, 0}, {-3, 2, 0}, {-3, -2, 0}, {1, -4, 0}}, {}};
  for (std::uint32_t k = 0; k < 5; ++k) {
    const std::uint32_t from = 2 + k, to = 2 + (k + 2) % 5;
    star.triangles.push_back({0, from, to});
    star.triangles.push_back({1, to, from});
  }
  CHECK(convexity_defect(star, 0) == INFINITY);
}

void no_solids() {
  Mesh open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  CHECK(convexity_defect(open, INFINITY) == INFINITY);
  CHECK(convexity_defect(reversed(box({0, 0, 0}, {1, 1, 1})), INFINITY) == INFINITY);
}

}  // namespace

UNIT(convexity) {
  unions_of_boxes();
  a_dent();
  random_hulls();
  a_star();
  no_solids();
}
