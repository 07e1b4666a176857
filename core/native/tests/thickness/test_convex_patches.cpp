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

// From random points, the nearest patch is as far as the nearest triangle.
bool keeps_distances(const Mesh& mesh, const ConvexPatches& patches) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> coordinate(-2, 2);
  for (int sample = 0; sample < 200; ++sample) {
    const Vec3 p{coordinate(random), coordinate(random), coordinate(random)};
    double of_patches = INFINITY, of_triangles = INFINITY;
    for (const Patch& patch : patches.patches) of_patches = std::fmin(of_patches, patches.distance(patch, p));
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      of_triangles = std::fmin(of_triangles, norm(nearest_on_triangle(p, corners(mesh, t)) - p));
    }
    if (std::fabs(of_patches - of_triangles) > 1e-14) return false;
  }
  return true;
}

}  // namespace

UNIT(convex_patches) {
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
