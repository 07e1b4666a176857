// The least work for a query of the peer harness (bench/README.md): the textbook methods in float64 with the support
// functions of satcheck, and no proof, no bounds of rounding, no exact stage. It is a limit to compare with, not a peer:
// near contact its answers are wrong.
//  floor   boxes: 15 axes (SAT); hulls: GJK, which stops early for overlap; EPA for depth
#include <algorithm>
#include <cfloat>
#include <vector>

#include "convex/box_axes.hpp"
#include "convex/minkowski.hpp"
#include "placed_pairs.hpp"

namespace {

using satcheck::MinkowskiDifference;
using satcheck::Vec3;

// Vertices of A - B, the newest last. The closest point to the origin needs the newest, because it came closer.
struct PlainSimplex {
  Vec3 vertex[4];
  int count = 0;

  SATCHECK_INLINE void add(Vec3 w) { vertex[count++] = w; }
  SATCHECK_INLINE Vec3 keep(Vec3 v, std::initializer_list<Vec3> corners) {
    count = 0;
    for (const Vec3& corner : corners) vertex[count++] = corner;
    return v;
  }
};

SATCHECK_INLINE Vec3 on_edge(Vec3 a, Vec3 b) {
  const Vec3 ab = b - a;
  return a + ab * (std::fmax(-dot(a, ab), 0) / norm_squared(ab));
}

SATCHECK_INLINE Vec3 closest_on_edge(PlainSimplex& s, Vec3 a, Vec3 b) {
  return s.keep(on_edge(a, b), {b, a});
}

// Inside, or on the nearer one of the edges at `a` that the origin is beyond.
SATCHECK_INLINE Vec3 closest_on_triangle(PlainSimplex& s, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, n = cross(ab, ac);
  const bool beyond_c = dot(cross(n, ac), a) < 0, beyond_b = dot(cross(ab, n), a) < 0;
  if (!beyond_b && !beyond_c) return s.keep(n * (dot(n, a) / norm_squared(n)), {c, b, a});
  const Vec3 to_b = on_edge(a, b), to_c = on_edge(a, c);
  return norm_squared(to_b) < norm_squared(to_c) ? s.keep(to_b, {b, a}) : s.keep(to_c, {c, a});
}

// False if the tetrahedron encloses the origin. Else the closest point of the faces at the newest vertex that look at it.
SATCHECK_INLINE bool closest_on_tetrahedron(PlainSimplex& s, Vec3& v) {
  const Vec3 a = s.vertex[3], faces[3][3] = {{s.vertex[0], s.vertex[1], s.vertex[2]},
                                             {s.vertex[1], s.vertex[2], s.vertex[0]},
                                             {s.vertex[2], s.vertex[0], s.vertex[1]}};
  PlainSimplex best;
  double least = DBL_MAX;
  for (const auto& [b, c, opposite] : faces) {
    const Vec3 n = cross(b - a, c - a);
    if (dot(n, opposite - a) * dot(n, a) <= 0) continue;  // the origin is on the side of the opposite vertex
    PlainSimplex on_face;
    const Vec3 closest = closest_on_triangle(on_face, a, b, c);
    if (norm_squared(closest) < least) least = norm_squared(v = closest), best = on_face;
  }
  if (least == DBL_MAX) return false;
  s = best;
  return true;
}

enum class GjkEnd { apart, encloses, contact };

struct PlainGjk {
  GjkEnd end;
  Vec3 v;
  PlainSimplex simplex;
};

// The closest point of A - B to the origin. Without `distance`, stops at the first axis that separates.
SATCHECK_WIDE PlainGjk plain_gjk(const MinkowskiDifference& m, bool distance) {
  PlainGjk g{GjkEnd::contact, {}, {}};
  g.simplex.add(g.v = m.support(m.b_in_a.translation).w);
  double squared = norm_squared(g.v);
  while (squared > 0) {
    const Vec3 w = m.support(-g.v).w;
    const double along = dot(g.v, w);
    if (along > 0) {
      if (!distance) return {GjkEnd::apart, g.v, g.simplex};
      g.end = GjkEnd::apart;
      if (squared - along <= 8 * DBL_EPSILON * squared) break;
    }
    PlainSimplex& s = g.simplex;
    s.add(w);
    Vec3 v;
    if (s.count == 2) {
      v = closest_on_edge(s, w, Vec3(s.vertex[0]));
    } else if (s.count == 3) {
      v = closest_on_triangle(s, w, Vec3(s.vertex[0]), Vec3(s.vertex[1]));
    } else if (!closest_on_tetrahedron(s, v)) {
      g.end = GjkEnd::encloses;
      return g;
    }
    if (!(norm_squared(v) < squared)) break;
    g.v = v;
    squared = norm_squared(v);
  }
  return g;
}

struct Facet {
  int corner[3];
  Vec3 normal;  // unit, outward
  double distance;
};

// The depth by expanding the tetrahedron of GJK, which encloses the origin.
class PlainEpa {
 public:
  PlainEpa(const MinkowskiDifference& m, const PlainSimplex& s) : m_(m) {
    points_.assign(s.vertex, s.vertex + 4);
    const Vec3 a = points_[0];
    if (dot(points_[3] - a, cross(points_[1] - a, points_[2] - a)) > 0) std::swap(points_[1], points_[2]);
    for (const auto& c : {std::array{0, 1, 2}, std::array{0, 3, 1}, std::array{0, 2, 3}, std::array{1, 3, 2}}) add(c[0], c[1], c[2]);
  }

  SATCHECK_WIDE Facet nearest() {
    for (int round = 0; round < 1000; ++round) {
      const Facet best = *std::min_element(facets_.begin(), facets_.end(),
                                           [](const Facet& f, const Facet& g) { return f.distance < g.distance; });
      const Vec3 w = m_.support(best.normal).w;
      if (dot(best.normal, w) - best.distance <= 1e-13 * m_.scale || !expand(w)) return best;
    }
    return facets_.front();
  }

 private:
  void add(int i, int j, int k) {
    const Vec3 n = cross(points_[j] - points_[i], points_[k] - points_[i]);
    const Vec3 unit = n * (1 / norm(n));
    facets_.push_back({{i, j, k}, unit, dot(unit, points_[i])});
  }

  // Replaces the facets that `w` sees by a fan around it. False if it sees none.
  bool expand(Vec3 w) {
    horizon_.clear();
    std::size_t kept = 0;
    for (const Facet& f : facets_) {
      if (!(dot(f.normal, w) > f.distance)) {
        facets_[kept++] = f;
        continue;
      }
      for (int i = 0; i < 3; ++i) {
        const std::pair<int, int> edge{f.corner[i], f.corner[(i + 1) % 3]};
        const auto twin = std::find(horizon_.begin(), horizon_.end(), std::pair{edge.second, edge.first});
        if (twin == horizon_.end()) {
          horizon_.push_back(edge);
        } else {
          *twin = horizon_.back();
          horizon_.pop_back();
        }
      }
    }
    facets_.resize(kept);
    if (horizon_.empty()) return false;
    points_.push_back(w);
    for (const auto& [i, j] : horizon_) add(i, j, static_cast<int>(points_.size()) - 1);
    return true;
  }

  const MinkowskiDifference& m_;
  std::vector<Vec3> points_;
  std::vector<Facet> facets_;
  std::vector<std::pair<int, int>> horizon_;
};

SATCHECK_INLINE satcheck::PlacedBoxes boxes_of(const PlacedPair& p) {
  return satcheck::placed_boxes(p.pose_a.rotation, p.a->size, p.pose_b.rotation, p.b->size,
                                p.pose_b.translation - p.pose_a.translation, p.a->extent + p.b->extent);
}

SATCHECK_INLINE bool apart(satcheck::Lanes overlap) {
  return satcheck::bits_of_three(overlap < satcheck::all_lanes(0)) != 0;
}

SATCHECK_WIDE bool boxes_overlap(const PlacedPair& p) {
  const satcheck::PlacedBoxes boxes = boxes_of(p);
  satcheck::BoxAxes axes;
  measure_faces(boxes, axes);
  if (apart(axes.overlap[0]) || apart(axes.overlap[1])) return false;
  measure_edges(boxes, axes);
  return !apart(satcheck::smaller(axes.overlap[2], satcheck::smaller(axes.overlap[3], axes.overlap[4])));
}

SATCHECK_WIDE void depth_of_boxes(const PlacedPair& p, Out& out) {
  const satcheck::LeastOverlap least = least_overlap(boxes_of(p));
  out.sd = -least.penetration;
  for (int i = 0; i < 3; ++i) out.n[i] = least.axis[i];
}

class Floor : public Peer {
 public:
  int caps() const override { return CAP_BOOL | CAP_PEN | CAP_DIST; }
  void load(const PairFile& file) override { pairs_.load(file); }
  int overlap(int i) override {
    const PlacedPair& p = pairs_[i];
    if (are_boxes(p)) return boxes_overlap(p);
    return plain_gjk(difference_of(p), false).end == GjkEnd::encloses;
  }
  bool pen(int i, Out& out) override {
    const PlacedPair& p = pairs_[i];
    if (are_boxes(p)) {
      depth_of_boxes(p, out);
      return true;
    }
    const MinkowskiDifference m = difference_of(p);
    const PlainGjk g = plain_gjk(m, false);
    if (g.end != GjkEnd::encloses) return false;
    const Facet facet = PlainEpa(m, g.simplex).nearest();
    out.sd = -facet.distance;
    copy(p.pose_a.rotation * facet.normal, out.n);
    return true;
  }
  bool dist(int i, Out& out) override {
    const PlainGjk g = plain_gjk(difference_of(pairs_[i]), true);
    if (g.end != GjkEnd::apart) return false;
    out.sd = norm(g.v);
    copy(pairs_[i].pose_a.rotation * (g.v * (-1 / out.sd)), out.n);
    return true;
  }

 private:
  static bool are_boxes(const PlacedPair& p) {
    return p.a->kind == satcheck::ShapeKind::box && p.b->kind == satcheck::ShapeKind::box;
  }
  static MinkowskiDifference difference_of(const PlacedPair& p) { return {*p.a, p.pose_a, *p.b, p.pose_b}; }

  PlacedPairs pairs_;
};

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, {{"floor", [] { return std::unique_ptr<Peer>(new Floor); }}});
}
