// Moving the origin loses nothing: every coordinate comes back.
#include "mesh_pair/moved_surface.hpp"

#include <random>

#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;

namespace {

Surface triangle_at(Vec3 offset, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> at(-size, size);
  Mesh mesh;
  for (int k = 0; k < 3; ++k) mesh.vertices.push_back(offset + Vec3{at(random), at(random), at(random)});
  mesh.triangles.push_back({0, 1, 2});
  return make_surface(mesh, false);
}

bool comes_back(const Surface& surface, Vec3 centre) {
  bool all = true;
  for (const Vec3 p : surface.mesh.vertices) all = all && (p - centre) + centre == p;
  return all;
}

}  // namespace

UNIT(moved_surface) {
  std::mt19937 random(3);
  for (const double far : {1e-3, 1.0, 1e9, 1e15}) {
    for (const double size : {1e-15, 1e-7, 1e-2, 0.125}) {
      for (int k = 0; k < 50; ++k) {
        const Vec3 offset = Vec3{1, -0.7, 0.3 * k} * far;
        const Surface a = triangle_at(offset, size * far, random), b = triangle_at(offset, size * far, random);
        const Vec3 centre = exact_centre(a, b);
        CHECK(comes_back(a, centre) && comes_back(b, centre));
        CHECK(std::fabs(centre.x - offset.x) <= 4 * size * far);
      }
    }
  }
  const Surface here = triangle_at({}, 1, random), there = triangle_at({1e9, 0, 0}, 1, random);
  CHECK(exact_centre(here, there) == Vec3{});
  // Differences of such coordinates are too small for exact predicates.
  const Surface tiny = triangle_at({1e-60, 1e-60, 1e-60}, 1e-75, random);
  const Vec3 centre = exact_centre(tiny, tiny);
  CHECK(centre == Vec3{} || comes_back(tiny, centre));
}
