#include "convex/polygon_gjk.hpp"

namespace satcheck {
namespace {

// Each step visits new corners, and most pairs need less than six.
constexpr int kMostSteps = 32;
// The search for the distance ends when the next corner is nearer by less than this share.
constexpr double kNoProgress = 1e-12;
// Whether the origin lies in the triangle, by more than `noise` of each product.
bool encloses(Vec2 p, Vec2 q, Vec2 r, double noise) {
  const double pq = cross(p, q), qr = cross(q, r), rp = cross(r, p);
  return (pq > noise && qr > noise && rp > noise) || (pq < -noise && qr < -noise && rp < -noise);
}

}  // namespace

OriginNearest nearest_to_origin(Vec2 p, Vec2 q) {
  const Vec2 along = q - p;
  const double from_p = -dot(p, along), length = dot(along, along);
  if (!(from_p > 0)) return {p, dot(p, p), false};
  if (!(from_p < length)) return {q, dot(q, q), false};
  const Vec2 normal{along.y, -along.x};
  const double height = dot(normal, p) / length;
  return {normal * height, height * height * length, true};
}

PolygonGjk gjk(const ConvexPolygon& a, const ConvexPolygon& b, Vec2 towards, bool to_distance) {
  PolygonGjk found;
  DifferenceCorner(&simplex)[3] = found.simplex;
  const double size = size_of(a) + size_of(b);
  simplex[0] = difference_support(a, b, towards);
  found.count = 1;
  OriginNearest nearest{simplex[0].w, dot(simplex[0].w, simplex[0].w), false};
  for (int step = 0; step < kMostSteps; ++step) {
    const Vec2 v = nearest.v;
    const double reach = size + std::fabs(v.x) + std::fabs(v.y);  // no corner of the difference is farther away
    const double noise = kDifferenceNoise * reach;
    if (!(nearest.squared > noise * noise)) return found;
    const DifferenceCorner next = difference_support(a, b, v);
    const double height = dot(v, next.w);
    if (height > 0 && height * height > noise * noise * nearest.squared) {
      found.finding = PolygonFinding::apart;
      if (!to_distance) return found;
    }
    const bool known = same(next, simplex[0]) || (found.count == 2 && same(next, simplex[1]));
    if (known || height >= nearest.squared * (1 - kNoProgress)) return found;
    if (found.count == 1) {
      simplex[found.count++] = next;
      nearest = nearest_to_origin(simplex[0].w, next.w);
    } else {
      if (encloses(simplex[0].w, simplex[1].w, next.w, noise * reach)) {
        simplex[found.count++] = next;
        found.finding = PolygonFinding::meet;
        return found;
      }
      const OriginNearest by_first = nearest_to_origin(simplex[0].w, next.w), by_second = nearest_to_origin(simplex[1].w, next.w);
      const bool first = by_first.squared < by_second.squared;
      nearest = first ? by_first : by_second;
      simplex[first] = next;
    }
    if (!nearest.inner) {
      const Vec2 w = simplex[1].w;
      if (nearest.v.x == w.x && nearest.v.y == w.y) simplex[0] = simplex[1];
      found.count = 1;
    }
  }
  return found;
}

}  // namespace satcheck
