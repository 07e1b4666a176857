// Contact classes against rational truth on a small lattice, where every degeneracy occurs, and on
// named cases.
#include "exact/triangle_pair.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "exact/predicates.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

using Integer = long long;
struct LatticePoint {
  Integer x, y, z;
};
LatticePoint operator-(LatticePoint a, LatticePoint b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Integer dot(LatticePoint a, LatticePoint b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
LatticePoint cross(LatticePoint a, LatticePoint b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
using Sheet = std::array<LatticePoint, 3>;

// Truth by linear programming over the rationals, without any orientation argument: the triangles
// meet when 0 lies in the hull of the nine corner differences, i.e. when no direction separates it
// strictly. For hulls of few integer points it suffices to try the normals of all pairs of
// differences, the differences themselves and the lines through two of them.
bool strictly_separable(const std::vector<LatticePoint>& points) {
  std::vector<LatticePoint> directions;
  for (const LatticePoint& p : points) directions.push_back(p);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < points.size(); ++j) {
      const LatticePoint e = points[j] - points[i];
      const LatticePoint n = cross(points[i], points[j]);
      directions.push_back(cross(e, n));  // the point of the line i j nearest to the origin
      for (std::size_t k = 0; k < points.size(); ++k) {
        directions.push_back(cross(e, points[k] - points[i]));
      }
    }
  }
  for (const LatticePoint& d : directions) {
    for (const Integer sign : {1, -1}) {
      const bool separates = std::all_of(points.begin(), points.end(), [&](const LatticePoint& p) { return sign * dot(d, p) > 0; });
      if (separates) return true;
    }
  }
  return false;
}

bool truth_meets(const Sheet& a, const Sheet& b) {
  std::vector<LatticePoint> differences;
  for (const LatticePoint& p : a)
    for (const LatticePoint& q : b) differences.push_back(p - q);
  return !strictly_separable(differences);
}

Corners to_corners(const Sheet& t, double unit) {
  Corners c;
  for (int i = 0; i < 3; ++i) c[i] = Vec3{t[i].x * unit, t[i].y * unit, t[i].z * unit};
  return c;
}

void lattice_triangles() {
  std::mt19937 generator(1);
  std::uniform_int_distribution<int> coordinate(0, 2);
  int meeting = 0, crossing = 0;
  for (int round = 0; round < testing::rounds(30000); ++round) {
    Sheet a, b;
    for (Sheet* t : {&a, &b})
      for (LatticePoint& p : *t) p = {coordinate(generator), coordinate(generator), coordinate(generator)};
    const bool meets = truth_meets(a, b);
    const TriangleContact contact = classify(to_corners(a, 0.1), to_corners(b, 0.1));
    // 0.1 * {0, 1, 2} is a lattice in float64 too: 0.2 == 2 * 0.1.
    if (!CHECK((contact != TriangleContact::disjoint) == meets)) {
      for (const Sheet* t : {&a, &b})
        for (const LatticePoint& p : *t) std::fprintf(stderr, "%lld %lld %lld  ", p.x, p.y, p.z);
      std::fprintf(stderr, "contact %d truth %d\n", static_cast<int>(contact), meets);
    }
    CHECK(classify(to_corners(b, 0.1), to_corners(a, 0.1)) == contact);
    meeting += meets;
    if (contact != TriangleContact::crossing) continue;
    ++crossing;
    // A crossing survives every small push of one triangle.
    for (int push = 0; push < 6; ++push) {
      Corners moved = to_corners(b, 0.1);
      Vec3 step;
      (push % 3 == 0 ? step.x : push % 3 == 1 ? step.y : step.z) = push < 3 ? 1e-9 : -1e-9;
      for (Vec3& p : moved) p = p + step;
      CHECK(classify(to_corners(a, 0.1), moved) == TriangleContact::crossing);
    }
    const Vec3 p = crossing_point(to_corners(a, 1), to_corners(b, 1));
    for (const Sheet* t : {&a, &b}) {
      const LatticePoint n = cross((*t)[1] - (*t)[0], (*t)[2] - (*t)[0]);
      const Vec3 normal{n.x * 1.0, n.y * 1.0, n.z * 1.0};
      CHECK(std::fabs(dot(normal, p - to_corners(*t, 1)[0])) < 1e-14 * norm(normal));
    }
  }
  std::printf("%d of %d meet, %d cross\n", meeting, testing::rounds(30000), crossing);
  CHECK(meeting > testing::rounds(3000) && crossing > testing::rounds(300));
}

void named_cases() {
  const Corners floor{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};
  const auto with = [&](Vec3 p, Vec3 q, Vec3 r) { return classify(floor, {p, q, r}); };
  CHECK(with({1, 1, -1}, {1, 1, 1}, {2, 1, 1}) == TriangleContact::crossing);
  CHECK(with({1, 1, 0}, {1, 1, 1}, {2, 1, 1}) == TriangleContact::touching);
  CHECK(with({4, 0, 0}, {5, 0, 1}, {5, 1, 0}) == TriangleContact::touching);
  CHECK(with({0, 0, 0}, {4, 0, 0}, {0, 0, 4}) == TriangleContact::touching);
  CHECK(with({1, 1, 1}, {2, 1, 1}, {1, 2, 1}) == TriangleContact::disjoint);
  CHECK(with({1, 1, 0}, {1, 1, 0}, {1, 1, 0}) == TriangleContact::touching);
  CHECK(with({1, 1, -1}, {1, 1, 0}, {1, 1, 1}) == TriangleContact::touching);
  CHECK(with({3, 3, -1}, {3, 3, 0}, {3, 3, 1}) == TriangleContact::disjoint);
  // Both straddle, and the common segment ends on edges of both.
  CHECK(with({0, 1, -1}, {0, 1, 1}, {6, 1, 0}) == TriangleContact::crossing);

  CHECK(coplanar_overlap(floor, floor) == CoplanarOverlap::agreeing);
  CHECK(coplanar_overlap(floor, {floor[0], floor[2], floor[1]}) == CoplanarOverlap::opposing);
  CHECK(coplanar_overlap(floor, {Vec3{4, 0, 0}, Vec3{4, 4, 0}, Vec3{0, 4, 0}}) == CoplanarOverlap::none);
  CHECK(coplanar_overlap(floor, {Vec3{1, 1, 0}, Vec3{9, 1, 0}, Vec3{1, 9, 0}}) == CoplanarOverlap::agreeing);
}

}  // namespace

UNIT(triangle_pair) {
  lattice_triangles();
  named_cases();
}
