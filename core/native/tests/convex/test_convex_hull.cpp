// Hulls against Euler's formula, exact containment and known polytopes, in every dimension.
#include <algorithm>
#include <chrono>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>

#include "convex/convex_hull.hpp"
#include "convex/shape.hpp"
#include "exact/predicates.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

using Points = std::vector<Vec3>;

bool contains_all(const Polytope& hull, const Points& points) {
  for (const Triangle& t : hull.triangles) {
    const Vec3 a = hull.vertices[t[0]], b = hull.vertices[t[1]], c = hull.vertices[t[2]];
    for (const Vec3& p : points) {
      if (orientation(a, b, c, p) > 0) return false;
    }
  }
  return true;
}

// Every edge has an upward twin, faces are planar and edges name the faces on their two sides.
void check_structure(const Polytope& hull, const Points& points) {
  CHECK(hull.dimension == 3);
  const auto v = static_cast<long>(hull.vertices.size());
  const auto e = static_cast<long>(hull.edges.size());
  const auto f = static_cast<long>(hull.face_count());
  CHECK(v - e + f == 2);
  CHECK(static_cast<long>(hull.triangles.size()) == 2 * v - 4);
  CHECK(hull.source.size() == hull.vertices.size());
  for (std::size_t i = 0; i < hull.source.size(); ++i) CHECK(points[hull.source[i]] == hull.vertices[i]);
  for (const PolytopeEdge& edge : hull.edges) {
    CHECK(edge.left != edge.right);
    const auto follows = [&](std::uint32_t face, std::uint32_t tail, std::uint32_t head) {
      const auto first = hull.face_vertex.begin() + hull.face_offset[face];
      const auto last = hull.face_vertex.begin() + hull.face_offset[face + 1];
      const auto at = std::find(first, last, tail);
      if (at == last) return false;
      return (at + 1 == last ? *first : *(at + 1)) == head;
    };
    CHECK(follows(edge.left, edge.tail, edge.head));
    CHECK(follows(edge.right, edge.head, edge.tail));
  }
}

Points cube_grid(int n, double size) {
  Points points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        points.push_back(Vec3{i * 1.0, j * 1.0, k * 1.0} * (size / (n - 1)));
  return points;
}

Points sphere(int n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Points points;
  for (int i = 0; i < n; ++i) {
    const Vec3 p{normal(generator), normal(generator), normal(generator)};
    points.push_back(p * (1 / norm(p)));
  }
  return points;
}

void lower_dimensions() {
  CHECK(convex_hull({{1, 2, 3}}).dimension == 0);
  CHECK(convex_hull({{1, 2, 3}, {1, 2, 3}}).vertices.size() == 1);
  const Polytope segment = convex_hull({{1, 1, 1}, {0, 0, 0}, {3, 3, 3}, {2, 2, 2}, {0, -0.0, 0}});
  CHECK(segment.dimension == 1);
  CHECK(segment.vertices.size() == 2 && segment.source[0] == 1 && segment.source[1] == 2);
  Points square;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) square.push_back({i * 0.25, j * 0.25, i * 0.25 + j * 0.25});
  const Polytope polygon = convex_hull(square);
  CHECK(polygon.dimension == 2);
  CHECK(polygon.vertices.size() == 4 && polygon.face_count() == 2 && polygon.edges.size() == 4);
  CHECK(polygon.triangles.size() == 4);
  CHECK(norm(polygon.face_normal[0] + polygon.face_normal[1]) < 1e-15);
  bool refused = false;
  try {
    convex_hull({{0, 0, NAN}});
  } catch (const std::invalid_argument&) {
    refused = true;
  }
  CHECK(refused);
}

void cube_with_many_coplanar_points() {
  Points grid = cube_grid(12, 1.1);
  const Points copy = grid;
  grid.insert(grid.end(), copy.begin(), copy.end());
  std::shuffle(grid.begin(), grid.end(), std::mt19937(3));
  const Polytope hull = convex_hull(grid);
  check_structure(hull, grid);
  CHECK(hull.vertices.size() == 8 && hull.face_count() == 6 && hull.edges.size() == 12);
  CHECK(contains_all(hull, grid));
}

void rotated_grid_is_not_quite_flat() {
  Points grid = cube_grid(8, 1.0);
  const double s = std::sin(0.7), c = std::cos(0.7);
  for (Vec3& p : grid) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  for (Vec3& p : grid) p = {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
  const Polytope hull = convex_hull(grid);
  check_structure(hull, grid);
  CHECK(contains_all(hull, grid));
}

void order_does_not_matter() {
  Points points = sphere(200, 4);
  const Polytope first = convex_hull(points);
  std::shuffle(points.begin(), points.end(), std::mt19937(5));
  const Polytope second = convex_hull(points);
  CHECK(first.vertices == second.vertices);
  CHECK(first.face_vertex == second.face_vertex);
  CHECK(first.triangles == second.triangles);
}

void slivers_and_random_clouds() {
  std::mt19937 generator(6);
  std::uniform_int_distribution<int> coordinate(-2, 2);
  for (int round = 0; round < testing::rounds(500); ++round) {
    Points points;
    for (int i = 0; i < 14; ++i) {
      points.push_back({coordinate(generator) * 1.0, coordinate(generator) * 0.1, coordinate(generator) * 1e-17 + 0.3});
    }
    const Polytope hull = convex_hull(points);
    if (hull.dimension == 3) {
      check_structure(hull, points);
      CHECK(contains_all(hull, points));
    }
  }
  for (const double thickness : {1.0, 1e-8, 1e-16, 1e-30}) {
    Points points = sphere(300, 7);
    for (Vec3& p : points) p.z *= thickness;
    const Polytope hull = convex_hull(points);
    check_structure(hull, points);
    CHECK(contains_all(hull, points));
    for (const Vec3& n : hull.face_normal) CHECK(std::fabs(norm(n) - 1) < 1e-15);
  }
}

void random_lattice_clouds() {
  std::mt19937 generator(8);
  std::uniform_int_distribution<int> coordinate(-2, 2);
  for (int round = 0; round < testing::rounds(2000); ++round) {
    Points points;
    for (int i = 0; i < 4 + round % 30; ++i) {
      points.push_back(Vec3{coordinate(generator) * 1.0, coordinate(generator) * 1.0, coordinate(generator) * 1.0});
    }
    const Polytope hull = convex_hull(points);
    if (hull.dimension != 3) continue;
    check_structure(hull, points);
    CHECK(contains_all(hull, points));
  }
}

void large_inputs() {
  const auto timed = [](const char* name, const Points& points) {
    const auto start = std::chrono::steady_clock::now();
    const Polytope hull = convex_hull(points);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    std::printf("%s: %zu points, %zu extreme, %.3f s\n", name, points.size(), hull.vertices.size(),
                elapsed.count());
    check_structure(hull, points);
  };
  timed("sphere", sphere(testing::rounds(100000), 9));
  timed("grid", cube_grid(46, 3.0));
  Points ball = sphere(testing::rounds(100000), 10);
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> radius(0, 1);
  for (Vec3& p : ball) p = p * std::cbrt(radius(generator));
  timed("ball", ball);
  Points tube;
  for (int i = 0; i < testing::rounds(50000); ++i) {
    const double angle = i * 0.000125663706143592;
    tube.push_back({std::cos(angle), std::sin(angle), 0});
    tube.push_back({std::cos(angle), std::sin(angle), 1});
  }
  timed("tube", tube);
}

void triangles_without_faces() {
  std::mt19937 generator(12);
  std::uniform_int_distribution<int> coordinate(-3, 3);
  const auto point = [&] { return Vec3{coordinate(generator) * 0.1, coordinate(generator) * 0.1, coordinate(generator) * 0.1}; };
  for (int i = 0; i < testing::rounds(3000); ++i) {
    const std::array<Vec3, 3> t{point(), point(), point()};
    if (collinear(t[0], t[1], t[2])) continue;
    const Shape shape = make_triangle(t), hull = make_hull(Points(t.begin(), t.end()));
    CHECK(!shape.has_faces && shape.origin == hull.origin && shape.polytope.vertices == hull.polytope.vertices);
  }
}

// Triangles contain all points, use every extreme point, and leave no edge open.
void triangles_of_the_hull() {
  std::mt19937 generator(13);
  std::uniform_int_distribution<int> coordinate(-3, 3);
  for (int i = 0; i < testing::rounds(300); ++i) {
    Points points;
    for (int k = 0; k < 12; ++k) points.push_back(Vec3{coordinate(generator) * 0.1, coordinate(generator) * 0.1, coordinate(generator) * 0.1});
    const Polytope hull = convex_hull(points);
    const HullTriangles boundary = hull_triangles(points);
    CHECK(boundary.triangles.empty() == (hull.dimension < 3));
    if (hull.dimension < 3) continue;
    std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
    Points corners;
    for (const Triangle& t : boundary.triangles) {
      const Vec3 a = boundary.points[t[0]], b = boundary.points[t[1]], c = boundary.points[t[2]];
      for (const Vec3& p : points) CHECK(orientation(a, b, c, p) <= 0);
      corners.insert(corners.end(), {a, b, c});
      for (std::size_t k = 0; k < 3; ++k) CHECK(sides.insert({t[k], t[(k + 1) % 3]}).second);
    }
    for (const auto& [tail, head] : sides) CHECK(sides.contains({head, tail}));
    for (const Vec3& v : hull.vertices) CHECK(std::find(corners.begin(), corners.end(), v) != corners.end());
  }
}

}  // namespace

UNIT(convex_hull) {
  lower_dimensions();
  cube_with_many_coplanar_points();
  rotated_grid_is_not_quite_flat();
  order_does_not_matter();
  slivers_and_random_clouds();
  random_lattice_clouds();
  large_inputs();
  triangles_without_faces();
  triangles_of_the_hull();
}
