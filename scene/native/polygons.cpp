// Ear clipping: G. H. Meisters, "Polygons have ears" (1975). Seen along the axis nearest to its normal, a polygon is
// cut into triangles with its own orientation, by exact signs. The borders of these triangles add up to the border of
// the polygon. If no triangle has the other orientation, they cover the inside of the polygon exactly once. A fan from
// the first corner is used if it has this property, as for every convex polygon. A polygon that crosses itself may have
// no such triangles. It becomes a fan.
#include "polygons.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/rounding.hpp"
#include "base/vec.hpp"
#include "builder.hpp"
#include "exact/predicates.hpp"

namespace satcheck::scene {
namespace {

constexpr std::uint64_t most_steps = 5'000'000'000;  // a few seconds

constexpr std::uint64_t sign_steps = 16;  // cost of a sign that rounding does not hide, in comparisons

Vec3 point(const MeshData& mesh, std::uint32_t vertex) {
  const double* at = mesh.vertices.data() + 3 * std::size_t{vertex};
  return {at[0], at[1], at[2]};
}

void push(std::uint32_t a, std::uint32_t b, std::uint32_t c, MeshData& mesh) {
  for (const std::uint32_t corner : {a, b, c}) mesh.triangles.push_back(corner);
}

void push_fan(std::span<const std::uint32_t> corners, MeshData& mesh) {
  for (std::size_t i = 2; i < corners.size(); ++i) push(corners[0], corners[i - 1], corners[i], mesh);
}

// Whether the two triangles of a quadrilateral's fan certainly face the same way. This is the usual case and needs no
// exact signs.
bool is_plainly_convex_fan(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  const double turned = dot(cross(ab, ac), cross(ac, ad));
  // Each product of the two cross products carries fewer than 16 roundings of terms no larger than these lengths.
  constexpr double bound = 64 * kUnitRoundoff;
  const double lengths = dot(ab, ab) * dot(ac, ac) * dot(ac, ac) * dot(ad, ad);
  return turned > 0 && turned * turned > bound * bound * lengths;
}

// A polygon seen along an axis, so that it turns counter-clockwise.
class Outline {
 public:
  Outline(std::span<const std::uint32_t> corners, const MeshData& mesh, Budget& budget) : corners_(corners), budget_(budget) {
    Vec3 normal{0, 0, 0};  // twice the area, after Newell
    const Vec3 origin = point(mesh, corners[0]);
    for (std::size_t i = 2; i < corners.size(); ++i) {
      normal = normal + cross(point(mesh, corners[i - 1]) - origin, point(mesh, corners[i]) - origin);
    }
    const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
    flat_ = !(x + y + z > 0) || !std::isfinite(x + y + z);
    points_.reserve(corners.size());
    for (const std::uint32_t corner : corners) {
      const Vec3 p = point(mesh, corner);
      Vec3 seen = x >= y && x >= z ? Vec3{p.y, p.z, 0} : y >= z ? Vec3{p.z, p.x, 0} : Vec3{p.x, p.y, 0};
      const double along = x >= y && x >= z ? normal.x : y >= z ? normal.y : normal.z;
      if (along < 0) std::swap(seen.x, seen.y);
      points_.push_back(seen);
    }
  }

  bool fan_covers() {
    for (std::size_t i = 2; i < points_.size(); ++i) {
      if (turn(0, i - 1, i) <= 0) return false;
    }
    return true;
  }

  // The triangles; empty if the polygon cannot be cut.
  std::vector<std::uint32_t> ears() {
    std::vector<std::uint32_t> triangles;
    left_.resize(points_.size());
    for (std::size_t i = 0; i < left_.size(); ++i) left_[i] = i;
    std::size_t from = 0;
    while (left_.size() > 3) {
      std::size_t at = find_ear(from, 1);
      if (at == left_.size()) at = find_ear(from, 0);  // three corners in a line
      if (at == left_.size()) return {};
      clip(at, triangles);
      from = at == 0 ? 0 : at - 1;  // where the corners have changed
    }
    if (turn(left_[0], left_[1], left_[2]) < 0) return {};
    clip(1, triangles);
    return triangles;
  }

  bool is_flat() const { return flat_; }

 private:
  int turn(std::size_t a, std::size_t b, std::size_t c) {
    if (budget_.spent() > most_steps) fail(code::too_large, "the polygons of the file are too intricate to be cut into triangles: cut them before");
    const Vec3 above{points_[a].x, points_[a].y, 1};
    const int sign = orientation(points_[a], points_[b], points_[c], above, &budget_);
    budget_.spend(sign_steps);
    return sign;
  }

  // The first corner from `from` on whose triangle has the orientation `wanted` and contains no other corner; the
  // number of corners: there is none.
  std::size_t find_ear(std::size_t from, int wanted) {
    const std::size_t n = left_.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t at = (from + k) % n;
      const std::size_t a = left_[(at + n - 1) % n], b = left_[at], c = left_[(at + 1) % n];
      if (turn(a, b, c) == wanted && (wanted == 0 || is_empty(a, b, c))) return at;
    }
    return n;
  }

  bool is_empty(std::size_t a, std::size_t b, std::size_t c) {
    const auto [low_x, high_x] = std::minmax({points_[a].x, points_[b].x, points_[c].x});
    const auto [low_y, high_y] = std::minmax({points_[a].y, points_[b].y, points_[c].y});
    for (const std::size_t other : left_) {
      const Vec3 p = points_[other];
      budget_.spend(1);
      if (p.x < low_x || p.x > high_x || p.y < low_y || p.y > high_y) continue;
      if (is_at(other, a) || is_at(other, b) || is_at(other, c)) continue;
      if (turn(a, b, other) >= 0 && turn(b, c, other) >= 0 && turn(c, a, other) >= 0) return false;
    }
    return true;
  }

  bool is_at(std::size_t i, std::size_t j) const { return points_[i].x == points_[j].x && points_[i].y == points_[j].y; }

  void clip(std::size_t at, std::vector<std::uint32_t>& triangles) {
    const std::size_t n = left_.size();
    for (const std::size_t corner : {left_[(at + n - 1) % n], left_[at], left_[(at + 1) % n]}) {
      triangles.push_back(corners_[corner]);
    }
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
  }

  std::span<const std::uint32_t> corners_;
  Budget& budget_;
  std::vector<Vec3> points_;
  std::vector<std::size_t> left_;
  bool flat_ = false;
};

void cut(std::span<const std::uint32_t> corners, MeshData& mesh, Budget& budget) {
  if (corners.size() == 4 && is_plainly_convex_fan(point(mesh, corners[0]), point(mesh, corners[1]), point(mesh, corners[2]),
                                                   point(mesh, corners[3]))) {
    return push_fan(corners, mesh);
  }
  Outline outline(corners, mesh, budget);
  if (outline.is_flat() || outline.fan_covers()) return push_fan(corners, mesh);
  const std::vector<std::uint32_t> triangles = outline.ears();
  if (triangles.empty()) return push_fan(corners, mesh);
  mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
}

}  // namespace

void Polygons::add_other(const std::vector<std::uint32_t>& corners, std::int64_t place, MeshData& mesh) {
  if (corners.size() < 3) {
    if (too_short_++ == 0) first_short_ = place;
  } else if (*std::max_element(corners.begin(), corners.end()) >= mesh.vertices.size() / 3) {
    waiting_.emplace_back(corners, mesh.objects.size());
  } else {
    cut(corners, mesh, budget_);
  }
}

void Polygons::finish(const char* unit, MeshData& mesh) {
  for (const auto& [corners, objects] : waiting_) {
    if (objects > 0) mesh.spans.push_back({static_cast<std::uint32_t>(objects - 1), mesh.triangles.size() / 3});
    cut(corners, mesh, budget_);
  }
  if (too_short_ == 0) return;
  mesh.warnings.push_back({code::short_face, std::to_string(too_short_) + (too_short_ == 1 ? " face has" : " faces have") +
                                                 " fewer than 3 vertices and was ignored (first: " + unit + " " +
                                                 std::to_string(first_short_) + ")"});
}

}  // namespace satcheck::scene
