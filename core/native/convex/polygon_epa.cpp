#include "convex/polygon_epa.hpp"

#include <cmath>
#include <utility>

namespace satcheck {
namespace {

constexpr int kMostEdges = 40;
// Of the distance of an edge from the origin, as a share of the largest corner: both ends 1, along 1 more, the products
// and their sum 4, the quotient and the root 2, rounded up.
constexpr double kEdgeNoise = 16 * kUnitRoundoff;

struct Edge {
  DifferenceCorner p, q;  // counter-clockwise
  double squared;         // the distance from the origin
};

Edge edge_of(const DifferenceCorner& p, const DifferenceCorner& q) { return {p, q, nearest_to_origin(p.w, q.w).squared}; }

int nearest_of(const Edge* edges, int count) {
  int best = 0;
  for (int k = 1; k < count; ++k) best = edges[k].squared < edges[best].squared ? k : best;
  return best;
}

}  // namespace

PolygonEpa epa(const ConvexPolygon& a, const ConvexPolygon& b, const PolygonGjk& found) {
  DifferenceCorner corner[3] = {found.simplex[0], found.simplex[1], found.simplex[2]};
  if (cross(corner[0].w, corner[1].w) < 0) std::swap(corner[1], corner[2]);
  Edge edges[kMostEdges];
  int count = 0;
  for (; count < 3; ++count) edges[count] = edge_of(corner[count], corner[(count + 1) % 3]);
  const double size = size_of(a) + size_of(b);  // no corner is farther from the origin
  while (count < kMostEdges) {
    Edge& edge = edges[nearest_of(edges, count)];
    const Vec2 along = edge.q.w - edge.p.w, inward{-along.y, along.x};
    const DifferenceCorner next = difference_support(a, b, inward);
    const double gain = -dot(inward, next.w - edge.p.w);
    if (same(next, edge.p) || same(next, edge.q) || !(gain > kDifferenceNoise * size * std::sqrt(dot(along, along)))) {
      return {true, edge.p, edge.q, std::sqrt(edge.squared) - kEdgeNoise * size};
    }
    edges[count++] = edge_of(next, edge.q);
    edge = edge_of(edge.p, next);
  }
  return {};
}

}  // namespace satcheck
