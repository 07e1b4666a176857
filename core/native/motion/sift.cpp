// Separating axes: GJK on the difference of the two hulls (E. G. Gilbert, D. W. Johnson, S. S. Keerthi, 1988), from the
// axis that separated the pair in the pose before. Every axis on the way may be the proof, so most pairs take one step.
#include "motion/sift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "convex/closest_point.hpp"
#include "mesh/boundary.hpp"
#include "motion/balls.hpp"
#include "motion/posed_surfaces.hpp"

namespace satcheck {
namespace {

// The computed height of the difference of two placed hulls along a unit axis is off by at most this, times the sum of
// both reaches. The choice of the corners: 3 roundings of the direction and 3 of the height, for the chosen and for the
// true corner, 12. The chosen corners in the world: 6. Difference, length of the axis and product: 7. The vertices in
// the world: 2. Rounded up.
constexpr double kPosedRounding = 64 * kUnitRoundoff;

double rounding_between(const PosedPlace& a, const PosedPlace& b) { return kPosedRounding * (a.reach + b.reach); }

// The poses that one thread takes at a time. Neighbours in a list of poses are often close to each other, and the axis
// of a pair starts anew with each block, so that threads do not change the result.
constexpr std::size_t kBlock = 64;
constexpr int kMostAxes = 32;
// Steps of a pair whose hulls are not apart, beside its walks.
constexpr std::uint64_t kStepsOfPair = 1000;

// A body in the pose at hand.
struct Place {
  PosedPlace at;
  std::vector<Ball> inner;  // in the world
  bool has_inner = false;
};

struct Corner {
  Vec3 point;
  std::uint32_t index;
};

SATCHECK_INLINE Corner support(const VertexLanes& corners, const PosedPlace& at, Vec3 direction) {
  const std::uint32_t i = support_index(corners, transpose_times(at.linear, direction));
  return {at.linear * Vec3{corners.x[i], corners.y[i], corners.z[i]} + at.offset, i};
}

struct Search {
  bool apart = false;
  Vec3 axis;  // the last one, from B to A
};

// axis: the first one to try, of any length except 0. enough: a height that exceeds all rounding and the gap limit.
SATCHECK_WIDE Search seek_axis(const PosedBody& a, const PosedPlace& at_a, const PosedBody& b, const PosedPlace& at_b,
                               Vec3 axis, double enough) {
  Vec3 point[4];
  std::array<std::uint32_t, 2> seen[4];
  int count = 0;
  double nearest = INFINITY;
  axis = axis * (1 / norm(axis));
  for (int step = 0; step < kMostAxes; ++step) {
    const Corner on_a = support(a.corners(), at_a, -axis), on_b = support(b.corners(), at_b, axis);
    const Vec3 w = on_a.point - on_b.point;
    const double height = dot(axis, w);
    if (height > enough) return {true, axis};
    const std::array<std::uint32_t, 2> corners{on_a.index, on_b.index};
    for (int i = 0; i < count; ++i) {
      if (seen[i] == corners) return {false, axis};
    }
    point[count] = w;
    seen[count++] = corners;
    const ClosestPoint closest = closest_point<true>(point[0], point[1], point[2], point[3], count);
    const double distance = std::sqrt(closest.distance_squared);
    if (!(distance < nearest) || !(distance > 0)) return {false, axis};
    nearest = distance;
    if (nearest < enough) return {false, axis};  // the hulls are nearer than the gap limit
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      point[kept] = point[i];
      seen[kept] = seen[i];
      kept += closest.carriers >> i & 1;
    }
    count = kept;
    axis = closest.v * (1 / distance);
  }
  return {false, axis};
}

Vec3 column(const Mat3& m, int i) { return {m.row[0][i], m.row[1][i], m.row[2][i]}; }

// Whether a point of A is farther out than all of B by more than `margin`: along the line of their centres, or along an
// axis of either file.
bool sticks_out(PosedBody& a, const PosedPlace& at_a, PosedBody& b, const PosedPlace& at_b, double margin) {
  const double enough = margin + b.margin() * at_b.stretch.most + rounding_between(at_a, at_b);
  const auto is_farther_along = [&](Vec3 axis) {
    const double length = norm(axis);
    if (!(length > 0)) return false;
    const Vec3 way = axis * (1 / length);
    return dot(way, support(a.own_corners(), at_a, way).point - support(b.corners(), at_b, way).point) > enough;
  };
  if (is_farther_along(at_a.around.centre - at_b.around.centre)) return true;
  for (int i = 0; i < 6; ++i) {
    const Vec3 axis = column(i < 3 ? at_b.linear : at_a.linear, i % 3);
    if (is_farther_along(axis) || is_farther_along(-axis)) return true;
  }
  return false;
}

struct Side {
  PosedBody& body;
  const PosedPlace& at;

  bool is_open() const { return !body.surface().solid; }
  const Surface& closed() const { return is_open() ? *body.filled().closing->surface : body.surface(); }
  // Whether rounding may merge vertices, which can close a hole.
  bool may_merge(double rounding) const { return is_open() && !(body.filled().distance * at.stretch.least > 2 * rounding); }
};

bool holds_a_part(const Surface& hull, const PosedPlace& at_hull, Side other, double rounding) {
  const Surface& surface = other.closed();
  return std::any_of(surface.parts.begin(), surface.parts.end(), [&](std::uint32_t t) {
    const Vec3 vertex = surface.mesh.vertices[surface.mesh.triangles[t][0]];
    return is_clear(hull, at_hull, other.at.linear * vertex + other.at.offset, rounding, true);
  });
}

bool have_common_interior(const Surface& hull, const PosedPlace& at_hull, Side other, double rounding) {
  Budget budget;
  const auto segment = crossing_of(hull, at_hull, other.closed(), other.at, budget);
  if (segment) return ball_beside(*segment, hull, at_hull, other.closed(), other.at, rounding);
  return holds_a_part(hull, at_hull, other, rounding);
}

// Whether the hull of a hole of the first body is in the way of the second one.
bool is_in_the_way(const Surface& hull, Side holed, Side other, double rounding) {
  if (hull.mesh.vertices.empty() || !have_common_interior(hull, holed.at, other, rounding)) return false;
  const Vec3 rim = holed.at.linear * hull.mesh.vertices[0] + holed.at.offset;
  return is_clear(other.closed(), other.at, rim, rounding, false);
}

bool hole_in_the_way(Side holed, Side other, double rounding) {
  if (!holed.is_open()) return false;
  const std::vector<Surface>& hulls = holed.body.filled().closing->hulls;
  return std::any_of(hulls.begin(), hulls.end(),
                     [&](const Surface& hull) { return is_in_the_way(hull, holed, other, rounding); });
}

// Two bodies, at least one of them open. True: the hull of a hole has a common inner point with the other body, and a
// point outside of it, however the vertices in the world are rounded by at most `rounding`. The bodies have meshes whose
// surfaces do not meet.
bool fills_differ(PosedBody& a, const PosedPlace& at_a, PosedBody& b, const PosedPlace& at_b, double rounding) {
  const Side of_a{a, at_a}, of_b{b, at_b};
  if (of_a.may_merge(rounding) || of_b.may_merge(rounding)) return false;
  return hole_in_the_way(of_a, of_b, rounding) || hole_in_the_way(of_b, of_a, rounding);
}

class PoseSifter {
 public:
  PoseSifter(const std::vector<PosedBody*>& bodies, const std::vector<SiftedPair>& pairs, std::uint64_t steps)
      : bodies_(bodies), pairs_(pairs), places_(bodies.size()), axes_(pairs.size()), budget_(steps) {}

  std::uint64_t spent() const { return budget_.spent(); }

  void take(const double* matrices, const double* margins, Sifted* results) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      places_[k].at = place_at(*bodies_[k], matrices + 12 * k);
      places_[k].has_inner = false;
    }
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const double margin = margins == nullptr ? 0 : margins[k];
      results[k] = std::isnan(margin) ? Sifted::open : sifted(pairs_[k], pairs_[k].gap_limit + margin, axes_[k]);
    }
  }

 private:
  Sifted sifted(const SiftedPair& pair, double gap_limit, Vec3& axis) {
    PosedBody &a = *bodies_[pair.a], &b = *bodies_[pair.b];
    Place &place_a = places_[pair.a], &place_b = places_[pair.b];
    const PosedPlace &at_a = place_a.at, &at_b = place_b.at;
    const double rounding = rounding_between(at_a, at_b);
    const double limit = gap_limit * (1 + 4 * kUnitRoundoff) + rounding;
    const Vec3 between = at_a.around.centre - at_b.around.centre;
    const double centres = norm(between);
    if (centres - at_a.around.radius - at_b.around.radius > limit) return Sifted::apart;
    if (!(centres > 0) && axis == Vec3{}) axis = {1, 0, 0};
    const double grown = a.margin() * at_a.stretch.most + b.margin() * at_b.stretch.most;
    const Search search = seek_axis(a, at_a, b, at_b, axis == Vec3{} ? between : axis, limit + grown);
    axis = search.axis;
    if (search.apart) return Sifted::apart;
    budget_.spend(kStepsOfPair);
    if (budget_.is_spent()) return Sifted::open;
    const double depth = pair.depth + rounding;
    const bool asked = pair.depth < INFINITY;
    if (asked && have_deep_point(place_a, place_b, a, b, depth)) return Sifted::deep;
    const bool have_meshes = a.has_mesh() && b.has_mesh();
    // A crossing of a mesh around a body proves no overlap.
    const auto [meeting, segment] = meeting_of(a, at_a, b, at_b, gap_limit, have_meshes ? pair.crossing : INFINITY, budget_);
    if (budget_.is_spent()) return Sifted::open;
    if (meeting == Meeting::apart) return Sifted::apart;
    if (meeting == Meeting::deep) return Sifted::deep;
    if (meeting == Meeting::by_fill && have_meshes && fills_differ(a, at_a, b, at_b, rounding)) return Sifted::undecided;
    const Surface *in_a = a.material(), *in_b = b.material();
    if (!asked || !in_a || !in_b) return Sifted::open;
    const auto crossing = have_meshes ? segment : crossing_of(*in_a, at_a, *in_b, at_b, budget_);
    const bool deep = crossing && ball_beside(*crossing, *in_a, at_a, *in_b, at_b, depth);
    return deep ? Sifted::deep : Sifted::open;
  }

  const std::vector<Ball>& inner(PosedBody& body, Place& place) {
    if (!place.has_inner) {
      place.has_inner = true;
      place.inner = in_world(place.at, body.inner());
    }
    return place.inner;
  }

  // Whether two inner balls have a ball in common whose centre is that deep in both.
  bool have_deep_point(Place& place_a, Place& place_b, PosedBody& a, PosedBody& b, double depth) {
    return any_overlap(inner(a, place_a), inner(b, place_b), depth);
  }

  const std::vector<PosedBody*>& bodies_;
  const std::vector<SiftedPair>& pairs_;
  std::vector<Place> places_;
  std::vector<Vec3> axes_;  // where the search starts, for each pair; 0: between the centres
  Budget budget_;
};

}  // namespace

std::vector<bool> neither_holds(const std::vector<PosedBody*>& bodies, const std::vector<DeepPair>& pairs,
                                const double* matrices) {
  std::vector<bool> results;
  for (const auto& [pose, i, j, margin] : pairs) {
    PosedBody &a = *bodies[i], &b = *bodies[j];
    const double* rows = matrices + 12 * bodies.size() * pose;
    const PosedPlace at_a = place_at(a, rows + 12 * i), at_b = place_at(b, rows + 12 * j);
    results.push_back(sticks_out(a, at_a, b, at_b, margin) && sticks_out(b, at_b, a, at_a, margin));
  }
  return results;
}

std::vector<Sifted> sift(const std::vector<PosedBody*>& bodies, const std::vector<SiftedPair>& pairs,
                         const double* matrices, const double* margins, std::size_t poses, unsigned threads,
                         Budget* budget) {
  std::vector<Sifted> results(poses * pairs.size());
  const std::size_t blocks = (poses + kBlock - 1) / kBlock;
  const std::uint64_t most = budget == nullptr ? kNoEnd : budget->left() / std::max<std::size_t>(blocks, 1);
  std::vector<std::uint64_t> spent(blocks);
  parallel_for(blocks, threads, [&](std::size_t block) {
    PoseSifter sifter(bodies, pairs, most);
    for (std::size_t pose = kBlock * block; pose < std::min(poses, kBlock * (block + 1)); ++pose) {
      const double* own = margins == nullptr ? nullptr : margins + pairs.size() * pose;
      sifter.take(matrices + 12 * bodies.size() * pose, own, results.data() + pairs.size() * pose);
    }
    spent[block] = sifter.spent();
  });
  if (budget != nullptr) budget->spend(std::accumulate(spent.begin(), spent.end(), std::uint64_t{0}));
  return results;
}

}  // namespace satcheck
