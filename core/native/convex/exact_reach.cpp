// The nearest points of two disjoint convex bodies lie on a pair of features: two vertices, a vertex over the inside of
// an edge or a face, or two edges over the inside of each other. The squared distance is a quotient of polynomials in
// the coordinates, so comparing it with another square is a sign of integers. All such pairs of points lie in the
// bodies, so the least distance over all pairs of features is the distance of the bodies.

#include "convex/exact_reach.hpp"

#include <algorithm>
#include <optional>

#include "base/rounding.hpp"
#include "exact/triangle_distance.hpp"

namespace satcheck {

namespace {

struct ExactVec {
  Dyadic x, y, z;
};

ExactVec difference(Vec3 a, Vec3 b) {
  return {Dyadic(a.x) - Dyadic(b.x), Dyadic(a.y) - Dyadic(b.y), Dyadic(a.z) - Dyadic(b.z)};
}

Dyadic dot(const ExactVec& a, const ExactVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ExactVec cross(const ExactVec& a, const ExactVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// numerator / denominator, the latter positive: a squared distance.
struct Squared {
  Dyadic numerator, denominator;
};

struct Segment {
  Vec3 tail, head;
};

Squared between(Vec3 p, Vec3 q) {
  const ExactVec w = difference(p, q);
  return {dot(w, w), Dyadic(1)};
}

// Empty if the nearest point of the line is not inside the edge.
std::optional<Squared> between(Vec3 p, const Segment& edge) {
  const ExactVec w = difference(p, edge.tail), d = difference(edge.head, edge.tail);
  const Dyadic along = dot(w, d), length = dot(d, d);
  if (along.sign() <= 0 || (length - along).sign() <= 0) return std::nullopt;
  return Squared{dot(w, w) * length - along * along, length};
}

// Empty if the nearest point of the plane is not inside the triangle.
std::optional<Squared> between(Vec3 p, const Corners& t) {
  const ExactVec normal = cross(difference(t[1], t[0]), difference(t[2], t[0]));
  const Dyadic length = dot(normal, normal);
  if (length.sign() == 0) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    const ExactVec inward = cross(difference(t[(i + 1) % 3], t[i]), difference(p, t[i]));
    if (dot(inward, normal).sign() < 0) return std::nullopt;
  }
  const Dyadic height = dot(normal, difference(p, t[0]));
  return Squared{height * height, length};
}

// Empty if the nearest points of the lines are not inside both edges, or the edges are parallel.
std::optional<Squared> between(const Segment& p, const Segment& q) {
  const ExactVec d1 = difference(p.head, p.tail), d2 = difference(q.head, q.tail);
  const ExactVec r = difference(p.tail, q.tail), normal = cross(d1, d2);
  const Dyadic area = dot(normal, normal);
  if (area.sign() == 0) return std::nullopt;
  const Dyadic a = dot(d1, d1), b = dot(d1, d2), c = dot(d1, r), e = dot(d2, d2), f = dot(d2, r);
  const Dyadic s = b * f - c * e, t = a * f - b * c;
  for (const Dyadic& place : {s, t}) {
    if (place.sign() <= 0 || (area - place).sign() <= 0) return std::nullopt;
  }
  const Dyadic height = dot(normal, r);
  return Squared{height * height, area};
}

template <class Points>
Aabb bounds_of(const Points& points) {
  Aabb box;
  for (Vec3 p : points) box.include(p);
  return box;
}
Aabb bounds_of(Vec3 p) { return {p, p}; }
Aabb bounds_of(const Segment& s) { return bounds_of(std::array{s.tail, s.head}); }

// The features within reach of a box.
struct Features {
  std::vector<Vec3> vertices;
  std::vector<Segment> edges;
  std::vector<Corners> triangles;
};

class NearestFeatures {
 public:
  NearestFeatures(const Polytope& a, const Polytope& b, const Dyadic& length) : length_squared_(length * length) {
    // Roundings: five in a squared distance of boxes, four in the length (doubled by squaring), and one of the square.
    const double rounded = rounded_ratio(length, Dyadic(1));
    within_ = rounded * rounded * (1 + 32 * kUnitRoundoff);
    a_ = features_near(a, bounds_of(b.vertices));
    b_ = features_near(b, bounds_of(a.vertices));
  }

  int sign() {
    compare(a_.vertices, b_.vertices);
    compare(a_.vertices, b_.edges);
    compare(b_.vertices, a_.edges);
    compare(a_.vertices, b_.triangles);
    compare(b_.vertices, a_.triangles);
    compare(a_.edges, b_.edges);
    return least_;
  }

 private:
  bool near(const Aabb& p, const Aabb& q) const { return box_distance_squared(p, q) <= within_; }

  Features features_near(const Polytope& p, const Aabb& box) const {
    Features features;
    const auto keep = [&](auto& list, const auto& feature) {
      if (near(bounds_of(feature), box)) list.push_back(feature);
    };
    for (Vec3 v : p.vertices) keep(features.vertices, v);
    if (p.dimension == 1) keep(features.edges, Segment{p.vertices[0], p.vertices[1]});
    for (const PolytopeEdge& e : p.edges) keep(features.edges, Segment{p.vertices[e.tail], p.vertices[e.head]});
    for (const Triangle& t : p.triangles) {
      keep(features.triangles, Corners{p.vertices[t[0]], p.vertices[t[1]], p.vertices[t[2]]});
    }
    return features;
  }

  void compare(std::optional<Squared> distance) {
    if (distance) least_ = std::min(least_, (distance->numerator - length_squared_ * distance->denominator).sign());
  }

  template <class FeatureA, class FeatureB>
  void compare(const std::vector<FeatureA>& features_a, const std::vector<FeatureB>& features_b) {
    for (const FeatureA& a : features_a) {
      for (const FeatureB& b : features_b) {
        if (least_ < 0) return;
        if (near(bounds_of(a), bounds_of(b))) compare(std::optional(between(a, b)));
      }
    }
  }

  Dyadic length_squared_;
  double within_;
  Features a_, b_;
  int least_ = 1;
};

}  // namespace

int compare_distance(const Polytope& a, const Polytope& b, const Dyadic& length) {
  return length.sign() < 0 ? 1 : NearestFeatures(a, b, length).sign();
}

}  // namespace satcheck
