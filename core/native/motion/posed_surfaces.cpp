// The walk over both trees: S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree: A Hierarchical Structure for Rapid
// Interference Detection" (1996), with the boxes of both files.
#include "motion/posed_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/rounding.hpp"
#include "exact/triangle_pair.hpp"

namespace satcheck {
namespace {

// After so many pairs of triangles that prove nothing, the walk ends: for a crossing, and for a proof that bodies are apart.
constexpr int kMostUnclear = 64, kNoneUnclear = 1;
// Steps of a pair of boxes, and of a pair of triangles.
constexpr std::uint64_t kStepsOfBoxes = 30, kStepsOfTriangles = 100;

// A coordinate, a height or a width that is computed in the frame of A from coordinates of at most `size` is off by at
// most this times `size`: fewer than 64 roundings.
constexpr double kFrameRounding = 64 * kUnitRoundoff;
// An entry of a product of 3x3 matrices, compared with another matrix: 6 roundings of its terms, rounded up.
constexpr double kProductRounding = 8 * kUnitRoundoff;

Vec3 absolute(Vec3 v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
Mat3 absolute(const Mat3& m) { return {{absolute(m.row[0]), absolute(m.row[1]), absolute(m.row[2])}}; }
double sum(Vec3 v) { return v.x + v.y + v.z; }

// Where B is in the frame of A: takes points of B there.
struct Relative {
  Mat3 linear;
  Vec3 offset;
  double size = 0;   // bounds the sum of |terms| of the three coordinates of any vertex of A or B
  double slack = 0;  // bounds how far all rounding, that of the world included, moves a vertex of A towards one of B

  Vec3 operator*(Vec3 p) const { return linear * p + offset; }
};

Mat3 inverse_of(const Mat3& m) {
  const Vec3 x = cross(m.row[1], m.row[2]), y = cross(m.row[2], m.row[0]), z = cross(m.row[0], m.row[1]);
  const double by = 1 / dot(m.row[0], x);
  return {{Vec3{x.x, y.x, z.x} * by, Vec3{x.y, y.y, z.y} * by, Vec3{x.z, y.z, z.z} * by}};
}

Mat3 product(const Mat3& m, const Mat3& n) {
  const auto row = [&](Vec3 r) { return transpose_times(n, r); };
  return {{row(m.row[0]), row(m.row[1]), row(m.row[2])}};
}

// largest_a, largest_b: bound the |coordinates| of the vertices of A and B in their files.
Relative relative_place(const PosedPlace& at_a, Vec3 largest_a, const PosedPlace& at_b, Vec3 largest_b) {
  const Mat3 inverse = inverse_of(at_a.linear);
  Relative place{product(inverse, at_b.linear), inverse * (at_b.offset - at_a.offset)};
  place.size = sum(absolute(place.linear) * largest_b + absolute(place.offset)) + sum(largest_a);
  // How far the placement of A takes such a point from where the placement of B has it.
  const Mat3 back = product(at_a.linear, place.linear), terms = product(absolute(at_a.linear), absolute(place.linear));
  const Vec3 shift = at_a.linear * place.offset + at_a.offset - at_b.offset;
  const Vec3 shift_terms = absolute(at_a.linear) * absolute(place.offset) + absolute(at_a.offset) + absolute(at_b.offset);
  double error = sum(absolute(shift)) + kProductRounding * sum(shift_terms);
  for (int i = 0; i < 3; ++i) {
    const Vec3 wrong = absolute(back.row[i] - at_b.linear.row[i]);
    error += dot(wrong + (terms.row[i] + absolute(at_b.linear.row[i])) * kProductRounding, largest_b);
  }
  // Each coordinate in the world is rounded once.
  error += 2 * kUnitRoundoff * (at_a.reach + at_b.reach);
  place.slack = error / at_a.stretch.least * (1 + kProductRounding);
  return place;
}

CommonSegment in_world(const PosedPlace& at, const CommonSegment& segment) {
  return {at.linear * segment.middle + at.offset, at.linear * segment.inward};
}

struct Interval {
  double min, max;
};

Interval along(Vec3 axis, const Corners& c) {
  const double p = dot(axis, c[0]), q = dot(axis, c[1]), r = dot(axis, c[2]);
  return {smaller(p, smaller(q, r)), larger(p, larger(q, r))};
}

// Whether the triangles are farther apart than `gap` along an axis of any length. The sum of its coordinates is at
// least its length, and does not underflow.
bool apart_along(Vec3 axis, const Corners& a, const Corners& b, double gap) {
  const Interval of_a = along(axis, a), of_b = along(axis, b);
  const double between = larger(of_a.min - of_b.max, of_b.min - of_a.max);
  return between > gap * sum(absolute(axis));
}

bool are_apart(const Corners& a, const Corners& b, double gap) {
  const Vec3 of_a[] = {a[1] - a[0], a[2] - a[1], a[0] - a[2]}, of_b[] = {b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  if (apart_along(cross(of_a[0], of_a[1]), a, b, gap) || apart_along(cross(of_b[0], of_b[1]), a, b, gap)) return true;
  for (const Vec3 e : of_a) {
    for (const Vec3 f : of_b) {
      if (apart_along(cross(e, f), a, b, gap)) return true;
    }
  }
  return false;
}

// Where a segment meets a triangle, rounded, and a lower bound of the length of a translation after which it does not:
// negative if nothing is proven.
struct Piercing {
  Vec3 at;
  double depth;
};

// The ends of the segment are above and below the plane, and it meets the plane at a point whose distance to the edges a
// translation can change by its length over the sine of the angle of segment and plane.
std::optional<Piercing> piercing_of(Vec3 p, Vec3 q, const Corners& t, double size) {
  const Vec3 e = t[1] - t[0], f = t[2] - t[0], n = cross(e, f);
  const double area = norm(n);
  if (!(area > 0)) return {};
  const double above = dot(n, p - t[0]) / area, below = dot(n, t[0] - q) / area;
  if (above * below <= 0) return {};
  const double whole = above + below;
  const Vec3 way = q - p, at = p + way * (above / whole);
  double room = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = t[(i + 1) % 3] - t[i];
    room = smaller(room, dot(cross(edge, at - t[i]), n) / (area * norm(edge)));
  }
  if (!(room > 0)) return {};
  const double sine = std::fabs(whole) / norm(way);
  // The normal of a thin triangle is less exact.
  const double rounding = 8 * kFrameRounding * size * (1 + norm(e) * norm(f) / area);
  return Piercing{at, smaller(smaller(std::fabs(above), std::fabs(below)), room * sine) - rounding};
}

// Where the edges of either triangle pierce the other one; two points unless rounding hides one.
struct TriangleCrossing {
  int points = 0;
  Vec3 ends[2];
  double depth = -1;  // of the deepest piercing

  TriangleCrossing(const Corners& a, const Corners& b, double size) {
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      add(piercing_of(a[i], a[next], b, size));
      add(piercing_of(b[i], b[next], a, size));
    }
  }

 private:
  void add(const std::optional<Piercing>& piercing) {
    if (!piercing) return;
    depth = larger(depth, piercing->depth);
    if (points < 2) ends[points++] = piercing->at;
  }
};

// The boxes of B in the frame of A, and the axes along which they may be apart from those of A.
class TurnedBoxes {
 public:
  TurnedBoxes(const Relative& place, double gap) : place_(place), gap_(gap), extent_(absolute(place.linear)) {
    const Mat3& m = place.linear;
    for (int j = 0; j < 3; ++j) axis_[j] = {m.row[0][j], m.row[1][j], m.row[2][j]};
    for (int j = 0; j < 3; ++j) {
      reach_[j] = absolute(axis_[j]);
      own_[j] = {std::fabs(dot(axis_[j], axis_[0])), std::fabs(dot(axis_[j], axis_[1])), std::fabs(dot(axis_[j], axis_[2]))};
      pad_[j] = gap * sum(reach_[j]);
    }
  }

  bool apart(const Aabb& a, const Aabb& b) const {
    const Vec3 half_a = (a.max - a.min) * 0.5, half_b = (b.max - b.min) * 0.5;
    const Vec3 between = place_ * ((b.min + b.max) * 0.5) - (a.min + a.max) * 0.5;
    const Vec3 room = extent_ * half_b + half_a;
    if (std::fabs(between.x) > room.x + gap_ || std::fabs(between.y) > room.y + gap_ ||
        std::fabs(between.z) > room.z + gap_) {
      return true;
    }
    for (int j = 0; j < 3; ++j) {
      if (std::fabs(dot(axis_[j], between)) > dot(own_[j], half_b) + dot(reach_[j], half_a) + pad_[j]) return true;
    }
    return false;
  }

 private:
  const Relative& place_;
  double gap_;
  Mat3 extent_;
  Vec3 axis_[3], reach_[3], own_[3];
  double pad_[3];
};

Vec3 unit_normal(const Corners& t) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  return n * (1 / norm(n));
}

double determinant(const Mat3& m) { return dot(m.row[0], cross(m.row[1], m.row[2])); }

double longest(const Aabb& box) { return max_abs(box.size()); }

class Walk {
 public:
  // gap, depth: in the frame of A, all rounding included.
  Walk(const Surface& a, const Surface& b, const Relative& place, double gap, double depth, int most_unclear,
       Budget& budget)
      : a_(a),
        b_(b),
        place_(place),
        boxes_(place, gap),
        gap_(gap),
        depth_(depth),
        most_unclear_(most_unclear),
        budget_(budget) {}

  // In the frame of A, of the first two triangles that cross.
  const std::optional<CommonSegment>& common() const { return common_; }

  Meeting run() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, 0}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      budget_.spend(kStepsOfBoxes);
      if (budget_.is_spent()) return Meeting::unclear;
      const BvhNode &of_a = a_.bvh.nodes[i], &of_b = b_.bvh.nodes[j];
      if (boxes_.apart(of_a.box, of_b.box)) continue;
      if (of_a.is_leaf() && of_b.is_leaf()) {
        if (compare_leaves(of_a, of_b)) return Meeting::deep;
        if (unclear_ >= most_unclear_ || (std::isinf(depth_) && common_)) return Meeting::unclear;
      } else if (of_b.is_leaf() || (!of_a.is_leaf() && longest(of_a.box) > longest(of_b.box))) {
        open.insert(open.end(), {{of_a.first + 1, j}, {of_a.first, j}});
      } else {
        open.insert(open.end(), {{i, of_b.first + 1}, {i, of_b.first}});
      }
    }
    return unclear_ == 0 ? Meeting::apart : Meeting::unclear;
  }

 private:
  // Whether two of their triangles cross deeply.
  bool compare_leaves(const BvhNode& of_a, const BvhNode& of_b) {
    for (std::uint32_t k = of_b.first; k < of_b.first + of_b.count; ++k) {
      const Corners c = corners(b_.mesh, b_.bvh.order[k]);
      const Corners moved{place_ * c[0], place_ * c[1], place_ * c[2]};
      const Aabb box = bounds_of(moved).widened(gap_);
      if (!meet(box, of_a.box)) continue;
      for (std::uint32_t i = of_a.first; i < of_a.first + of_a.count; ++i) {
        if (!meet(box, box_at(a_.bvh, a_.mesh, i))) continue;
        budget_.spend(kStepsOfTriangles);
        const Corners other = corners(a_.mesh, a_.bvh.order[i]);
        if (are_apart(other, moved, gap_)) continue;
        const TriangleCrossing crossing(other, moved, place_.size);
        if (crossing.depth > depth_) return true;
        if (!common_ && crossing.points == 2) common_ = common_segment(crossing, other, moved);
        ++unclear_;
      }
    }
    return false;
  }

  CommonSegment common_segment(const TriangleCrossing& crossing, const Corners& of_a, const Corners& of_b) const {
    const double mirrored = determinant(place_.linear) < 0 ? -1 : 1;
    const Vec3 way = unit_normal(of_a) + unit_normal(of_b) * mirrored;
    const double length = norm(crossing.ends[1] - crossing.ends[0]);
    return {(crossing.ends[0] + crossing.ends[1]) * 0.5, way * (-length / norm(way))};
  }

  const Surface &a_, &b_;
  const Relative& place_;
  TurnedBoxes boxes_;
  double gap_, depth_;
  int most_unclear_, unclear_ = 0;
  Budget& budget_;
  std::optional<CommonSegment> common_;
};

// Whether holds(vertex) of a vertex of any part of the surface, which the placement takes into the frame of another body.
template <class Holds>
bool any_part(const Surface& surface, const Relative& place, Holds holds) {
  return std::any_of(surface.parts.begin(), surface.parts.end(), [&](std::uint32_t t) {
    return holds(place * surface.mesh.vertices[surface.mesh.triangles[t][0]]);
  });
}

// Whether a part of the inner body lies in the material of the outer one, or may lie in the fill of a hole. place: of
// the inner one.
bool may_reach_into(PosedBody& outer, PosedBody& inner, const Relative& place) {
  return any_part(inner.walls(), place, [&](Vec3 p) { return outer.may_hold(p); });
}

// Whether a part of the inner body lies in the material of the outer one for any fill. unknown: the answer at a point
// without a winding number.
bool reaches_into(PosedBody& outer, PosedBody& inner, const Relative& place, bool unknown) {
  return any_part(inner.surface(), place, [&](Vec3 p) { return outer.encloses(p).value_or(unknown); });
}

Vec3 largest_of(const Surface& surface) {
  const Aabb& box = surface.bvh.nodes[0].box;
  const Vec3 low = absolute(box.min), high = absolute(box.max);
  return {larger(low.x, high.x), larger(low.y, high.y), larger(low.z, high.z)};
}

}  // namespace

std::optional<CommonSegment> crossing_of(const Surface& a, const PosedPlace& at_a, const Surface& b, const PosedPlace& at_b,
                                         Budget& budget) {
  if (a.bvh.nodes.empty() || b.bvh.nodes.empty()) return {};
  const Relative b_in_a = relative_place(at_a, largest_of(a), at_b, largest_of(b));
  Walk walk(a, b, b_in_a, 0, INFINITY, kMostUnclear, budget);
  walk.run();
  return walk.common() ? std::optional(in_world(at_a, *walk.common())) : std::nullopt;
}

SurfaceMeeting meeting_of(PosedBody& a, const PosedPlace& at_a, PosedBody& b, const PosedPlace& at_b, double gap,
                          double depth, Budget& budget) {
  const Relative b_in_a = relative_place(at_a, a.largest(), at_b, b.largest());
  const Relative a_in_b = relative_place(at_b, b.largest(), at_a, a.largest());
  // Surfaces farther apart than this stay apart while all rounding is undone, in the frames of both.
  const double rounding = b_in_a.slack + a_in_b.slack * (at_b.stretch.most / at_a.stretch.least) + kFrameRounding * b_in_a.size;
  if (!std::isfinite(rounding)) return {};
  const double to_frame = (1 + kProductRounding) / at_a.stretch.least;
  const double least_gap = gap * to_frame + rounding, least_depth = depth * to_frame + rounding;
  Walk walk(a.surface(), b.surface(), b_in_a, least_gap, least_depth, kMostUnclear, budget);
  const Meeting meeting = walk.run();
  if (meeting == Meeting::unclear && walk.common()) return {meeting, in_world(at_a, *walk.common())};
  if (meeting != Meeting::apart) return {meeting, {}};
  const bool closed = a.surface().solid && b.surface().solid;
  const bool walls_apart =
      closed || Walk(a.walls(), b.walls(), b_in_a, least_gap, INFINITY, kNoneUnclear, budget).run() == Meeting::apart;
  if (walls_apart && !may_reach_into(a, b, b_in_a) && !may_reach_into(b, a, a_in_b)) return {Meeting::apart, {}};
  const auto nested = [&](bool unknown) { return reaches_into(a, b, b_in_a, unknown) || reaches_into(b, a, a_in_b, unknown); };
  if (depth <= gap && nested(false)) return {Meeting::deep, {}};
  return {closed || nested(true) ? Meeting::unclear : Meeting::by_fill, {}};
}

}  // namespace satcheck
