#include "depth/planes.hpp"

#include <algorithm>
#include <cmath>

#include "exact/predicates.hpp"

namespace satcheck {
namespace {

int axis_along(Vec3 unit) {
  if (unit.y == 0 && unit.z == 0) return 0;
  if (unit.z == 0 && unit.x == 0) return 1;
  return unit.x == 0 && unit.y == 0 ? 2 : -1;
}

// Rounding error of a computed point on a wall, as a share of the largest offset.
constexpr double kOnWall = 1e-12;
// If the normals of walls span less than this squared volume, their corner is not used.
constexpr double kFlattestCorner = 1e-12;

Vec3 on_one(const Wall& p) { return p.normal * p.offset; }

// The point of least norm on two planes: in the plane of their normals.
std::optional<Vec3> on_two(const Wall& p, const Wall& q) {
  const double c = dot(p.normal, q.normal), det = 1 - c * c;
  if (det < kFlattestCorner) return std::nullopt;
  return p.normal * ((p.offset - c * q.offset) / det) + q.normal * ((q.offset - c * p.offset) / det);
}

std::optional<Vec3> on_three(const Wall& p, const Wall& q, const Wall& r) {
  const Vec3 qr = cross(q.normal, r.normal), rp = cross(r.normal, p.normal), pq = cross(p.normal, q.normal);
  const double det = dot(p.normal, qr);
  if (det * det < kFlattestCorner) return std::nullopt;
  return (qr * p.offset + rp * q.offset + pq * r.offset) * (1 / det);
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

std::optional<Vec3> nearest_beyond(const std::vector<Wall>& walls) {
  if (walls.empty()) return Vec3{};
  double scale = 0;
  for (const Wall& w : walls) scale = std::fmax(scale, std::fabs(w.offset));
  std::optional<Vec3> best;
  const auto consider = [&](std::optional<Vec3> t) {
    if (!t || (best && norm_squared(*t) >= norm_squared(*best))) return;
    const bool beyond = std::all_of(walls.begin(), walls.end(), [&](const Wall& w) {
      return dot(w.normal, *t) >= w.offset - kOnWall * scale;
    });
    if (beyond) best = t;
  };
  const Wall& last = walls.back();
  consider(on_one(last));
  for (std::size_t i = 0; i + 1 < walls.size(); ++i) {
    consider(on_two(walls[i], last));
    for (std::size_t k = 0; k < i; ++k) consider(on_three(walls[k], walls[i], last));
  }
  return best;
}

}  // namespace satcheck
