#include "mesh_pair/moved_surface.hpp"

#include <cmath>

#include "base/numeric_range.hpp"
#include "mesh/topology.hpp"
#include "mesh/transform.hpp"

namespace satcheck {
namespace {

// Meshes farther from the origin than this many sizes are moved near it.
constexpr double kFar = 4;

// c is a multiple of a power of two g >= the size. Every coordinate x is at least 3.5 sizes from 0 and at most 1.5
// sizes from c. x - c is then a multiple of the last place of x, or of g, and smaller than x, so it is a float64.
double exact_middle(double low, double high) {
  const double size = high - low, middle = low * 0.5 + high * 0.5;
  if (!(std::fabs(middle) > kFar * size)) return 0;
  if (size == 0) return low;
  const double grid = std::ldexp(1.0, std::ilogb(size) + 1);
  return std::round(middle / grid) * grid;
}

bool stays_in_range(const Surface& surface, Vec3 centre) {
  for (const Vec3 p : surface.mesh.vertices) {
    const Vec3 q = p - centre;
    if (!in_range(q.x) || !in_range(q.y) || !in_range(q.z)) return false;
  }
  return true;
}

}  // namespace

Surface translated_surface(const Surface& still, Vec3 t) {
  if (still.solid) {
    MovedSurface moved(still);
    require_in_range(moved.at(t).mesh.vertices, "moved vertex");
    if (is_welded(moved.at(t).mesh)) return std::move(moved).take();
  }
  return refitted_surface(still, translate(still.mesh, t));
}

Vec3 exact_centre(const Surface& a, const Surface& b) {
  Aabb box = a.bvh.nodes[0].box;
  box.include(b.bvh.nodes[0].box);
  const Vec3 centre{exact_middle(box.min.x, box.max.x), exact_middle(box.min.y, box.max.y),
                    exact_middle(box.min.z, box.max.z)};
  return stays_in_range(a, centre) && stays_in_range(b, centre) ? centre : Vec3{};
}

}  // namespace satcheck
