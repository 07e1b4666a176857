#include "poses/posed_body.hpp"

#include <algorithm>
#include <cmath>

#include "base/numeric_range.hpp"
#include "base/rounding.hpp"
#include "mesh/closing.hpp"
#include "mesh/nearest_point.hpp"

namespace satcheck {
namespace {

// Centres of inner balls are tried on a grid with this many cells along the longest side of the body.
constexpr int kCells = 12;
constexpr std::size_t kMostBalls = 48;
// A centre that lies within this share of the radius of a larger ball adds little to that ball.
constexpr double kCovered = 0.5;
// The smallest useful ball, as a share of the longest side.
constexpr double kSmallest = 1.0 / 64;

std::vector<Ball> candidates(const Surface& surface, const Aabb& box) {
  const Vec3 size = box.max - box.min;
  const double longest = max_abs(size), step = longest / kCells;
  const double rounding = chain_rounding(std::max(max_abs(box.min), max_abs(box.max)));
  const auto cells = [&](double side) { return std::max(1, static_cast<int>(std::ceil(side / step))); };
  const int nx = cells(size.x), ny = cells(size.y), nz = cells(size.z);
  std::vector<Ball> balls;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (int k = 0; k < nz; ++k) {
        const Vec3 p = box.min + Vec3{(i + 0.5) * size.x / nx, (j + 0.5) * size.y / ny, (k + 0.5) * size.z / nz};
        const double radius = nearest_point(surface, p).distance - rounding;
        if (radius > kSmallest * longest) balls.push_back({p, radius});
      }
    }
  }
  std::sort(balls.begin(), balls.end(), [](const Ball& p, const Ball& q) {
    return p.radius != q.radius ? p.radius > q.radius : coordinates_less(p.centre, q.centre);
  });
  return balls;
}

std::vector<Ball> balls_inside(Geometry& geometry) {
  if (!geometry.solid()) return {};
  const auto surface = geometry.surface();
  std::vector<Ball> chosen;
  for (const Ball& ball : candidates(*surface, geometry.bounds())) {
    const auto covers = [&](const Ball& other) { return norm(ball.centre - other.centre) < kCovered * other.radius; };
    if (std::any_of(chosen.begin(), chosen.end(), covers)) continue;
    if (winding_number(*surface, ball.centre).value_or(0) == 0) continue;
    chosen.push_back(ball);
    if (chosen.size() == kMostBalls) break;
  }
  return chosen;
}

// By the circles of Gershgorin around the eigenvalues of M^T M, tight for a rotation and a scale.
Stretch stretch_of(const Mat3& m) {
  const Vec3 column[3] = {{m.row[0].x, m.row[1].x, m.row[2].x},
                          {m.row[0].y, m.row[1].y, m.row[2].y},
                          {m.row[0].z, m.row[1].z, m.row[2].z}};
  const double xy = std::fabs(dot(column[0], column[1])), xz = std::fabs(dot(column[0], column[2])),
               yz = std::fabs(dot(column[1], column[2]));
  const double xx = norm_squared(column[0]), yy = norm_squared(column[1]), zz = norm_squared(column[2]);
  const double rounding = 32 * kUnitRoundoff * (xx + yy + zz);
  const double least = std::min({xx - xy - xz, yy - xy - yz, zz - xz - yz}) - rounding;
  const double most = std::max({xx + xy + xz, yy + xy + yz, zz + xz + yz}) + rounding;
  return {std::sqrt(std::max(least, 0.0)), std::sqrt(most)};
}

}  // namespace

PosedBody::PosedBody(std::shared_ptr<Geometry> geometry) : geometry_(std::move(geometry)) {
  enclose(geometry_->hull_points()->points);
}

PosedBody::PosedBody(const std::vector<Vec3>& corners, double margin, std::vector<Ball> inner)
    : margin_(margin), inner_(std::move(inner)) {
  enclose(corners);
}

void PosedBody::enclose(const std::vector<Vec3>& corners) {
  corners_ = VertexLanes(corners);
  Aabb box;
  for (const Vec3& p : corners) {
    box.include(p);
    largest_ = {std::max(largest_.x, std::fabs(p.x)), std::max(largest_.y, std::fabs(p.y)),
                std::max(largest_.z, std::fabs(p.z))};
  }
  around_.centre = box.min * 0.5 + box.max * 0.5;
  for (const Vec3& p : corners) around_.radius = std::max(around_.radius, norm(p - around_.centre));
  around_.radius += margin_ + chain_rounding(max_abs(largest_));
}

const Surface& PosedBody::surface() {
  std::call_once(has_surface_, [&] { surface_ = geometry_->surface(); });
  return *surface_;
}

const Surface& PosedBody::walls() {
  const Surface& own = surface();
  if (own.solid) return own;
  std::call_once(has_walls_, [&] { walls_ = walled_surface(own, OpenParts::filled); });
  return *walls_;
}

bool PosedBody::may_hold(Vec3 point) {
  const auto within = [&](const Surface& closed) { return winding_number(closed, point).value_or(1) != 0; };
  const Surface& own = surface();
  if (own.solid) return within(own);
  const auto closing = closing_of(own, OpenParts::filled);
  return within(*closing->surface) || std::any_of(closing->hulls.begin(), closing->hulls.end(), within);
}

const std::vector<Ball>& PosedBody::inner() {
  if (geometry_) std::call_once(has_inner_, [&] { inner_ = balls_inside(*geometry_); });
  return inner_;
}

std::optional<Ball> PosedBody::ball_about(Vec3 point) const {
  if (!geometry_ || !geometry_->solid()) return {};
  const auto surface = geometry_->surface();
  const double radius = nearest_point(*surface, point).distance - chain_rounding(max_abs(largest_));
  if (!(radius > 0) || winding_number(*surface, point).value_or(0) == 0) return {};
  return Ball{point, radius};
}

PosedPlace place_at(const PosedBody& body, const double* m) {
  PosedPlace at;
  at.linear = {{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}};
  at.offset = {m[3], m[7], m[11]};
  at.stretch = stretch_of(at.linear);
  const Vec3 largest = body.largest();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 row = at.linear.row[axis];
    at.reach += std::fabs(row.x) * largest.x + std::fabs(row.y) * largest.y + std::fabs(row.z) * largest.z +
                std::fabs(at.offset[axis]);
  }
  // Such a placement is refused elsewhere, or shears; nothing is proven about it.
  if (!(at.reach <= kLargestCoordinate) || at.stretch.least == 0) at.reach = INFINITY;
  at.around = {at.linear * body.around().centre + at.offset, at.stretch.most * body.around().radius};
  return at;
}

}  // namespace satcheck
