#include "depth/corner_plane.hpp"

#include <cmath>

#include "exact/predicates.hpp"

namespace satcheck {
namespace {

int axis_along(Vec3 unit) {
  if (unit.y == 0 && unit.z == 0) return 0;
  if (unit.z == 0 && unit.x == 0) return 1;
  return unit.x == 0 && unit.y == 0 ? 2 : -1;
}

}  // namespace

double CornerPlane::distance(Vec3 t) const { return std::fabs(height - dot(normal, t)); }

Vec3 CornerPlane::nearest_to(Vec3 t) const {
  switch (axis) {
    case 0: return {height * normal.x, t.y, t.z};
    case 1: return {t.x, height * normal.y, t.z};
    case 2: return {t.x, t.y, height * normal.z};
    default: return t + normal * (height - dot(normal, t));
  }
}

std::vector<CornerPlane> corner_planes(const Corners& p, const Corners& q) {
  std::vector<CornerPlane> planes;
  for (const bool of_p : {true, false}) {
    const Corners& face = of_p ? p : q;
    const Vec3 normal = rounded_normal(face[0], face[1], face[2]);
    if (!(norm(normal) > 0)) continue;
    const Vec3 unit = normal * (1 / norm(normal));
    for (int k = 0; k < 3; ++k) {
      const Vec3 t = of_p ? q[k] - face[0] : face[0] - p[k];
      planes.push_back({dot(unit, t), axis_along(unit), unit});
    }
  }
  return planes;
}

}  // namespace satcheck
