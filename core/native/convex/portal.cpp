// Gary Snethen, "XenoCollide: Complex Collision Made Simple", in "Game Programming Gems 7" (2008), 2.5. A ray leads from
// a point inside A - B through the origin. A portal is a triangle of support points that it passes; portals move
// outwards until the origin lies on the inner side of one, or an axis separates.
//
// Deviations: the second support point is searched from the first edge towards the origin, as in GJK. Every queried
// direction may separate. Both results are proofs that exceed a bound of all rounding, and a pair without a proof stays
// open. Rounding and the limit of rounds therefore never cause a wrong answer.

#include "convex/portal.hpp"

#include <utility>

#include "convex/closest_point.hpp"

namespace satcheck {

namespace {

constexpr int kRounds = 64;

// Squares of lengths below this may have lost digits to underflow.
constexpr double kLeastSquare = 1e-290;

}  // namespace

SATCHECK_WIDE PortalResult seek_portal(const MinkowskiDifference& m, double noise) {
  const Vec3 inside = m.a.inside[0] - m.b_in_a * m.b.inside[1];
  Vec3 p[3], direction = -inside;
  int count = 0;
  double plane = 0;  // height of the portal along the direction
  PortalResult result;
  while (result.rounds < kRounds) {
    const Vec3 point = m.support(direction).w;
    ++result.rounds;
    const double square = norm_squared(direction), height = dot(direction, point), rounding = noise * std::sqrt(square);
    if (!(square >= kLeastSquare)) break;
    if (height < -rounding) {
      result.finding = PortalFinding::apart;
      break;
    }
    if (count < 2) {
      p[count++] = point;
    } else {
      const Vec3 across = cross(point, inside);
      const double side0 = dot(p[0], across), side1 = dot(p[1], across);
      if (count == 2) {
        // Seen from `inside`, the origin has to lie between the points.
        const int missed = side0 < 0 ? 1 : side1 > 0 ? 0 : 2;
        p[missed] = point;
        count += missed == 2;
      } else {
        if (height - plane <= rounding) break;
        // The planes through `inside`, the new point and each old point cut the portal into three. The ray passes one
        // of them.
        p[side0 > 0 ? (side1 > 0 ? 0 : 2) : (dot(p[2], across) > 0 ? 1 : 0)] = point;
      }
    }
    if (count == 1) {
      const Vec3 edge = p[0] - inside;
      direction = edge * dot(inside, edge) - inside * norm_squared(edge);
    } else if (count == 2) {
      direction = cross(p[0] - inside, p[1] - inside);
      if (dot(direction, inside) > 0) {  // it has to point towards the origin
        std::swap(p[0], p[1]);
        direction = -direction;
      }
    } else {
      direction = cross(p[1] - p[0], p[2] - p[0]);  // outwards
      plane = dot(direction, p[0]);
      if (plane > 0) {
        const double radius = enclosed_radius(inside, p[0], p[1], p[2]);
        if (radius - m.support_error() > noise) result.finding = PortalFinding::overlaps;
        break;
      }
    }
  }
  result.axis = direction;
  return result;
}

}  // namespace satcheck
