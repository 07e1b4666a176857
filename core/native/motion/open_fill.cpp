#include "motion/open_fill.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/closing.hpp"
#include "motion/balls.hpp"
#include "motion/posed_surfaces.hpp"

namespace satcheck {
namespace {

struct Side {
  PosedBody& body;
  const PosedPlace& at;

  bool is_open() const { return !body.surface().solid; }
  const Surface& closed() const { return is_open() ? *body.filled().closing->surface : body.surface(); }
  // Whether rounding may merge vertices, which can close a hole.
  bool may_merge(double rounding) const { return is_open() && !(body.filled().distance * at.stretch.least > 2 * rounding); }
};

bool holds_a_part(const Surface& hull, const PosedPlace& at_hull, Side other, double rounding) {
  const Surface& surface = other.closed();
  return std::any_of(surface.parts.begin(), surface.parts.end(), [&](std::uint32_t t) {
    const Vec3 vertex = surface.mesh.vertices[surface.mesh.triangles[t][0]];
    return is_clear(hull, at_hull, other.at.linear * vertex + other.at.offset, rounding, true);
  });
}

bool have_common_interior(const Surface& hull, const PosedPlace& at_hull, Side other, double rounding) {
  const auto segment = crossing_of(hull, at_hull, other.closed(), other.at);
  if (segment) return ball_beside(*segment, hull, at_hull, other.closed(), other.at, rounding);
  return holds_a_part(hull, at_hull, other, rounding);
}

// Whether the hull of a hole of the first body is in the way of the second one.
bool is_in_the_way(const Surface& hull, Side holed, Side other, double rounding) {
  if (hull.mesh.vertices.empty() || !have_common_interior(hull, holed.at, other, rounding)) return false;
  const Vec3 rim = holed.at.linear * hull.mesh.vertices[0] + holed.at.offset;
  return is_clear(other.closed(), other.at, rim, rounding, false);
}

bool hole_in_the_way(Side holed, Side other, double rounding) {
  if (!holed.is_open()) return false;
  const std::vector<Surface>& hulls = holed.body.filled().closing->hulls;
  return std::any_of(hulls.begin(), hulls.end(),
                     [&](const Surface& hull) { return is_in_the_way(hull, holed, other, rounding); });
}

Hole in_world(const Hole& hole, Side holed) {
  Hole placed;
  for (const BoundaryLoop& loop : hole.loops) {
    for (const std::uint32_t v : loop) {
      placed.box.include(holed.at.linear * holed.body.surface().mesh.vertices[v] + holed.at.offset);
    }
  }
  return placed;
}

std::optional<OpenHole> largest_in_the_way(Side holed, Side other, bool is_a, double rounding) {
  const Closing& closing = *holed.body.filled().closing;
  std::size_t largest = 0;
  Hole hole;
  double size = -INFINITY, next = -INFINITY;
  for (std::size_t k = 0; k < closing.holes.size(); ++k) {
    const Hole placed = in_world(closing.holes[k], holed);
    next = std::max(next, std::min(size, placed.diameter()));
    if (!(placed.diameter() > size)) continue;
    largest = k;
    hole = placed;
    size = placed.diameter();
  }
  if (!(size > next + 2 * rounding) || !is_in_the_way(closing.hulls[largest], holed, other, rounding)) return {};
  return OpenHole{is_a, 0, closing.holes.size(), hole.centre(), size};
}

}  // namespace

bool fills_differ(PosedBody& a, const PosedPlace& at_a, PosedBody& b, const PosedPlace& at_b, double rounding) {
  const Side of_a{a, at_a}, of_b{b, at_b};
  if (of_a.may_merge(rounding) || of_b.may_merge(rounding)) return false;
  return hole_in_the_way(of_a, of_b, rounding) || hole_in_the_way(of_b, of_a, rounding);
}

std::optional<OpenHole> open_hole(PosedBody& a, const PosedPlace& at_a, PosedBody& b, const PosedPlace& at_b,
                                  double rounding) {
  const Side of_a{a, at_a}, of_b{b, at_b};
  if (of_a.is_open() == of_b.is_open()) return {};
  return of_a.is_open() ? largest_in_the_way(of_a, of_b, true, rounding) : largest_in_the_way(of_b, of_a, false, rounding);
}

}  // namespace satcheck
