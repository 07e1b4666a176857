// Of the vectors from one corner to the others, the shortest is an edge. The two other edges and the diagonal between
// them are perpendicular to it; for the rest, the dot product with the edge is its square. The longest edge has the
// most accurate direction, so the axes begin with it.
#include "convex/box_frame.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "base/rounding.hpp"

namespace satcheck {
namespace {

// The corners of a box in world coordinates are rounded by a few roundoffs of its place. A box within this share of its
// size still has proofs; the general stages serve the others.
constexpr double kRoundedBox = 0.25 * kWidestInterval;

// What the rounding of the axes adds, as a share of the diagonal: each axis is off by less than 8 roundoffs, and by 6
// more in a pose, in the reach of both boxes and in their offset, which is at most the sum of their reaches.
constexpr double kFrameError = 64 * kUnitRoundoff;

bool is_shorter(Vec3 a, Vec3 b) { return norm_squared(a) < norm_squared(b); }

Vec3 unit(Vec3 v) { return v * (1 / norm(v)); }

// The edges at the first corner, from the shortest to the longest; empty if they cannot be those of a box.
std::optional<std::array<Vec3, 3>> edges_of(const std::vector<Vec3>& corners) {
  std::vector<Vec3> ways;
  for (std::size_t i = 1; i < corners.size(); ++i) ways.push_back(corners[i] - corners[0]);
  const Vec3 edge = *std::min_element(ways.begin(), ways.end(), is_shorter);
  if (!(norm_squared(edge) > 0x1p-900)) return std::nullopt;  // the squares would underflow
  std::erase_if(ways, [&](Vec3 way) { return !(std::fabs(dot(way, edge)) < 0.5 * norm_squared(edge)); });
  if (ways.size() != 3) return std::nullopt;
  std::sort(ways.begin(), ways.end(), is_shorter);
  return std::array{edge, ways[0], ways[1]};
}

}  // namespace

std::optional<BoxFrame> find_box(std::vector<Vec3> corners) {
  if (corners.size() != 8) return std::nullopt;
  std::sort(corners.begin(), corners.end(), coordinates_less);
  const auto edges = edges_of(corners);
  if (!edges) return std::nullopt;
  const Vec3 third = unit((*edges)[2]), second = unit((*edges)[1] - third * dot(third, (*edges)[1]));
  const Vec3 axes[3] = {cross(second, third), second, third};
  BoxFrame box;
  Vec3 low, high;
  for (int i = 0; i < 3; ++i) {
    const auto along = [&](Vec3 p, Vec3 q) { return dot(axes[i], p - corners[0]) < dot(axes[i], q - corners[0]); };
    const auto [first, last] = std::minmax_element(corners.begin(), corners.end(), along);
    low.at(i) = dot(axes[i], *first - corners[0]);
    high.at(i) = dot(axes[i], *last - corners[0]);
  }
  box.half = (high - low) * 0.5;
  const Vec3 middle = (low + high) * 0.5;
  box.rotation = {{{axes[0].x, axes[1].x, axes[2].x}, {axes[0].y, axes[1].y, axes[2].y}, {axes[0].z, axes[1].z, axes[2].z}}};
  box.centre = corners[0] + box.rotation * middle;
  std::array<bool, 8> seen{};  // a corner in each octant
  for (Vec3 p : corners) {
    const Vec3 q = transpose_times(box.rotation, p - box.centre);
    const Vec3 off{std::fabs(q.x) - box.half.x, std::fabs(q.y) - box.half.y, std::fabs(q.z) - box.half.z};
    box.error = std::fmax(box.error, norm(off));
    seen[(q.x > 0) + 2 * (q.y > 0) + 4 * (q.z > 0)] = true;
  }
  const double diagonal = norm(box.half);
  const bool is_in_all = std::all_of(seen.begin(), seen.end(), std::identity{});
  if (!is_in_all || !(box.error <= kRoundedBox * diagonal)) return std::nullopt;
  const bool is_aligned = std::all_of(axes, axes + 3, [](Vec3 axis) { return max_abs(axis) == 1; });
  if (!is_aligned) box.error += kFrameError * diagonal;
  return box;
}

}  // namespace satcheck
