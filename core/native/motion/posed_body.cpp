#include "motion/posed_body.hpp"

#include <algorithm>
#include <cmath>

#include "base/numeric_range.hpp"
#include "base/rounding.hpp"
#include "mesh/boundary.hpp"
#include "motion/balls.hpp"

namespace satcheck {
namespace {

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

// Shorter than 1, and along no line or plane of a usual mesh.
constexpr Vec3 kOblique{0.4812118, 0.5772157, 0.6597};

// A lower bound of the distance of any two of the points: the least difference of their heights in one direction.
double least_distance(const std::vector<Vec3>& points, double largest) {
  std::vector<double> heights;
  for (const Vec3& p : points) heights.push_back(dot(kOblique, p));
  std::sort(heights.begin(), heights.end());
  double least = INFINITY;
  for (std::size_t i = 1; i < heights.size(); ++i) least = std::min(least, heights[i] - heights[i - 1]);
  return least - chain_rounding(largest);
}

}  // namespace

PosedBody::PosedBody(std::shared_ptr<Geometry> geometry) : geometry_(std::move(geometry)), within_(geometry_) {
  enclose(geometry_->hull_points()->points);
}

PosedBody::PosedBody(const std::vector<Vec3>& corners, double margin, std::shared_ptr<Geometry> around,
                     std::shared_ptr<Geometry> within)
    : geometry_(std::move(around)), within_(std::move(within)), margin_(margin) {
  widen(geometry_->bounds().min);
  widen(geometry_->bounds().max);
  enclose(corners);
}

void PosedBody::widen(Vec3 p) {
  largest_ = {std::max(largest_.x, std::fabs(p.x)), std::max(largest_.y, std::fabs(p.y)),
              std::max(largest_.z, std::fabs(p.z))};
}

void PosedBody::enclose(const std::vector<Vec3>& corners) {
  corners_ = VertexLanes(corners);
  for (const Vec3& p : corners) widen(p);
  around_.centre = bounds_of(corners).centre();
  for (const Vec3& p : corners) around_.radius = std::max(around_.radius, norm(p - around_.centre));
  around_.radius += margin_ + chain_rounding(max_abs(largest_));
}

const VertexLanes& PosedBody::own_corners() {
  if (has_mesh()) return corners_;
  std::call_once(has_own_corners_, [&] { own_corners_ = VertexLanes(within_->hull_points()->points); });
  return own_corners_;
}

const Surface& PosedBody::surface() {
  std::call_once(has_surface_, [&] { surface_ = geometry_->surface(); });
  return *surface_;
}

const Surface* PosedBody::material() {
  std::call_once(has_material_, [&] {
    if (within_->solid()) material_ = within_->surface();
  });
  return material_.get();
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
  std::call_once(has_inner_, [&] {
    if (material()) inner_ = balls_inside(*material());
  });
  return inner_;
}

const FilledHoles& PosedBody::filled() {
  std::call_once(has_filled_, [&] {
    filled_ = {closing_of(surface(), OpenParts::filled), least_distance(surface().mesh.vertices, max_abs(largest_))};
  });
  return filled_;
}

std::optional<bool> PosedBody::encloses(Vec3 point) {
  const Surface& own = surface();
  const auto winding = winding_number(own.solid ? own : *closing_of(own, OpenParts::sheets)->surface, point);
  return winding ? std::optional(*winding != 0) : std::nullopt;
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

Ball in_world(const PosedPlace& at, const Ball& ball) {
  return {at.linear * ball.centre + at.offset, at.stretch.least * ball.radius};
}

std::vector<Ball> in_world(const PosedPlace& at, const std::vector<Ball>& balls) {
  std::vector<Ball> placed;
  for (const Ball& ball : balls) placed.push_back(in_world(at, ball));
  return placed;
}

Vec3 in_file(const PosedPlace& at, Vec3 p) {
  const Vec3 *row = at.linear.row, from = p - at.offset;
  const Vec3 x = cross(row[1], row[2]), y = cross(row[2], row[0]), z = cross(row[0], row[1]);
  return (x * from.x + y * from.y + z * from.z) * (1 / dot(row[0], x));
}

}  // namespace satcheck
