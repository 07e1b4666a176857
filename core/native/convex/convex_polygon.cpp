#include "convex/convex_polygon.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/numeric_range.hpp"
#include "exact/predicates.hpp"

namespace satcheck {

namespace {

constexpr double kTinyEdge = 0x1p-500, kTinyScale = 0x1p1000;

[[noreturn]] void refuse(std::size_t polygon, const char* reason) {
  throw std::invalid_argument("polygon " + std::to_string(polygon) + " " + reason);
}

// Whether a direction points down, or straight to the left: angles from pi to 2 pi.
bool points_down(Vec2 from, Vec2 to) { return to.y < from.y || (to.y == from.y && to.x < from.x); }

// No turn to the right, and one turn around in all. Reasons are for people.
void require_convex(const ConvexPolygon& p, std::size_t index) {
  if (p.count < 3) refuse(index, "has fewer than three corners");
  int left = 0, ups = 0;
  for (std::uint32_t i = 0; i < p.count; ++i) {
    const Vec2 from = p.corners[i], to = p.corners[p.next(i)], after = p.corners[p.next(p.next(i))];
    if (from.x == to.x && from.y == to.y) refuse(index, "has two successive corners that are equal");
    const int side = orientation(from, to, after);
    if (side < 0) refuse(index, "is not convex and counter-clockwise");
    left += side;
    ups += points_down(from, to) && !points_down(to, after);
  }
  if (left == 0) refuse(index, "has all corners on one line");
  if (ups != 1) refuse(index, "turns around more than once");
}

void require_in_range(const Vec2* corners, std::size_t count) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({corners[i].x, corners[i].y, 0});
  require_in_range(points, "corner");
}

Vec2 normal_of(Vec2 p, Vec2 q) {
  const EdgeLength length = edge_length(p, q);
  const Vec2 along = (q - p) * length.scale;
  return {along.y / length.scaled, -along.x / length.scaled};
}

void find_extremes(ConvexPolygon& p) {
  p.lowest = p.highest = 0;
  p.low = p.high = p.corners[0];
  for (std::uint32_t i = 1; i < p.count; ++i) {
    const Vec2 c = p.corners[i], lowest = p.corners[p.lowest], highest = p.corners[p.highest];
    if (c.y < lowest.y || (c.y == lowest.y && c.x < lowest.x)) p.lowest = i;
    if (c.y > highest.y || (c.y == highest.y && c.x > highest.x)) p.highest = i;
    p.low = {smaller(c.x, p.low.x), smaller(c.y, p.low.y)};
    p.high = {larger(c.x, p.high.x), larger(c.y, p.high.y)};
  }
}

std::uint32_t sectors_for(std::uint32_t corners) { return std::bit_ceil(std::max(corners, 4u)); }

// The direction at a pseudo_angle().
Vec2 direction_at(double angle) {
  const double quarter = std::floor(angle), along = angle - quarter;
  const Vec2 first{1 - along, along};
  const Vec2 turned[4] = {first, {-first.y, first.x}, -first, {first.y, -first.x}};
  return turned[static_cast<int>(quarter)];
}

void fill_sectors(const ConvexPolygon& p, std::uint32_t* starts) {
  std::uint32_t corner = p.climb(p.lowest, {1, 0});
  for (std::uint32_t k = 0; k < p.sectors; ++k) {
    corner = p.climb(corner, direction_at(4.0 * k / p.sectors));
    starts[k] = corner;
  }
}

}  // namespace

EdgeLength edge_length(Vec2 p, Vec2 q) {
  const Vec2 along = q - p;
  const double scale = larger(std::fabs(along.x), std::fabs(along.y)) < kTinyEdge ? kTinyScale : 1;
  const Vec2 scaled = along * scale;
  return {std::sqrt(dot(scaled, scaled)), scale};
}

ConvexPolygons::ConvexPolygons(std::vector<Vec2> corners, const std::vector<std::uint32_t>& starts)
    : corners_(std::move(corners)), normals_(corners_.size()) {
  if (starts.empty() || starts.front() != 0 || starts.back() != corners_.size()) {
    throw std::invalid_argument("starts begins with 0 and ends with the number of corners");
  }
  std::size_t sectors = 0;
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    if (starts[k] > starts[k + 1] || starts[k + 1] > corners_.size()) throw std::invalid_argument("starts decreases");
    sectors += sectors_for(starts[k + 1] - starts[k]);
  }
  sector_starts_.resize(sectors);
  std::uint32_t* free_sectors = sector_starts_.data();
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    const std::uint32_t count = starts[k + 1] - starts[k];
    ConvexPolygon p{&corners_[starts[k]], &normals_[starts[k]], count, 0, 0, {}, {}, free_sectors, sectors_for(count)};
    require_in_range(p.corners, p.count);
    require_convex(p, k);
    find_extremes(p);
    for (std::uint32_t i = 0; i < count; ++i) normals_[starts[k] + i] = normal_of(p.corners[i], p.corners[p.next(i)]);
    fill_sectors(p, free_sectors);
    free_sectors += p.sectors;
    polygons_.push_back(p);
  }
}

}  // namespace satcheck
