// Coplanar triangles become convex patches, at the distance of their triangles.
#include "thickness/convex_patches.hpp"

#include <numeric>
#include <random>

#include "exact/triangle_distance.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

ConvexPatches patches_of(const Mesh& mesh, double flatness) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return convex_patches(mesh, all, flatness);
}

bool keeps_distance(const Mesh& mesh, const ConvexPatches& patches, Vec3 p) {
  double of_patches = INFINITY, of_triangles = INFINITY;
  for (const Patch& patch : patches.patches) of_patches = std::fmin(of_patches, patches.distance(patch, p));
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    of_triangles = std::fmin(of_triangles, norm(nearest_on_triangle(p, corners(mesh, t)) - p));
  }
  return std::fabs(of_patches - of_triangles) <= 1e-14;
}

// From random points, the nearest patch is as far as the nearest triangle.
bool keeps_distances(const Mesh& mesh, const ConvexPatches& patches) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> coordinate(-2, 2);
  for (int sample = 0; sample < 200; ++sample) {
    if (!keeps_distance(mesh, patches, {coordinate(random), coordinate(random), coordinate(random)})) return false;
  }
  return true;
}

// Bars in any direction, with corners on one line but for rounding. A point on that line may be a digit beyond an edge
// that is far away.
void corners_on_one_line() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-1, 1);
  int merged = 0;
  for (int bar = 0; bar < 300; ++bar) {
    const Vec3 x{at(random), at(random), at(random)}, y = cross(x, {at(random), at(random), at(random)});
    Mesh mesh{{{}, x * 0.3, x, y, x * 0.3 + y, x + y}, {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}};
    const ConvexPatches patches = patches_of(mesh, 1e-12);
    merged += patches.patches.size() == 1;
    for (int sample = 0; sample < 20; ++sample) {
      CHECK(keeps_distance(mesh, patches, x * (0.5 + at(random) / 2)) && keeps_distance(mesh, patches, y + x * (0.5 + at(random) / 2)));
    }
  }
  CHECK(merged > 30);
}

}  // namespace

UNIT(convex_patches) {
  corners_on_one_line();
  const Mesh cube = box({-1, -1, -1}, {1, 1, 1});
  const ConvexPatches sides = patches_of(cube, 0);
  CHECK(sides.patches.size() == 6 && keeps_distances(cube, sides));
  for (const Patch& side : sides.patches) CHECK(side.count == 4 && side.triangle_count == 2 && side.slack == 0);
  for (const std::uint32_t patch : sides.patch_of) CHECK(patch < 6);

  // An L: its front is not convex, and stays two patches at least.
  Mesh bracket;
  bracket.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  bracket.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  const ConvexPatches front = patches_of(bracket, 0);
  CHECK(front.patches.size() == 2 && keeps_distances(bracket, front));

  // Bent by more than is allowed, or by less.
  Mesh bent;
  bent.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0x1p-20}, {0, 1, 0}};
  bent.triangles = {{0, 1, 2}, {0, 2, 3}};
  CHECK(patches_of(bent, 0).patches.size() == 2);
  const ConvexPatches flat = patches_of(bent, 0x1p-19);
  CHECK(flat.patches.size() == 1 && flat.patches[0].slack > 0);
}
