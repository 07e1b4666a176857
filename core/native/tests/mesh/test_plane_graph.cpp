// Faces of graphs whose parts lie within each other, or touch: names of one point are different nodes.
#include "mesh/plane_graph.hpp"

#include <vector>

#include "tests/check.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

using Polygon = std::vector<Vec3>;

constexpr Corners kPlane{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};

LazyPoint point(Vec3 p) {
  return {p, {}, [p] { return make_exact_point(p); }};
}

// A named graph of polygons, counter-clockwise and each with nodes of its own.
class Polygons {
 public:
  explicit Polygons(const std::vector<Polygon>& polygons) : graph_(kPlane, nullptr) {
    for (const Polygon& polygon : polygons) {
      std::vector<std::uint32_t>& nodes = nodes_.emplace_back();
      for (const Vec3 p : polygon) nodes.push_back(graph_.add_node(point(p)));
      for (std::size_t k = 0; k < nodes.size(); ++k) graph_.add_segment(nodes[k], nodes[(k + 1) % nodes.size()], 0, {});
    }
    graph_.build_named();
  }

  std::uint32_t inside(std::size_t polygon) const { return graph_.face(side_of(polygon)); }
  std::uint32_t outside(std::size_t polygon) const { return graph_.face(side_of(polygon) ^ 1); }
  const PlaneGraph& graph() const { return graph_; }

 private:
  std::uint32_t side_of(std::size_t polygon) const {
    const std::uint32_t from = nodes_[polygon][0], to = nodes_[polygon][1];
    std::uint32_t h = 0;
    while (graph_.start(h) != from || graph_.end(h) != to) ++h;
    return h;
  }

  PlaneGraph graph_;
  std::vector<std::vector<std::uint32_t>> nodes_;
};

Polygon square(double low, double high) { return {{low, low, 0}, {high, low, 0}, {high, high, 0}, {low, high, 0}}; }

// A triangle touches a square at its first node. Either may be added first.
void parts_that_touch() {
  const Polygon around = square(0, 8);
  const std::vector<Polygon> within = {{{0, 4, 0}, {2, 3, 0}, {2, 5, 0}}, {{0, 0, 0}, {2, 1, 0}, {1, 2, 0}}, {{0, 8, 0}, {1, 6, 0}, {2, 7, 0}}};
  const std::vector<Polygon> beyond = {{{8, 4, 0}, {9, 3, 0}, {9, 5, 0}}, {{8, 8, 0}, {9, 8.5, 0}, {8.5, 9, 0}}, {{8, 0, 0}, {8.5, -1, 0}, {9, -1, 0}}};
  for (const std::size_t first : {0, 1}) {
    for (const auto* triangles : {&within, &beyond}) {
      for (const Polygon& triangle : *triangles) {
        const Polygons graph(first == 0 ? std::vector{around, triangle} : std::vector{triangle, around});
        CHECK(graph.graph().face_count() == 3);
        CHECK(graph.outside(1 - first) == (triangles == &within ? graph.inside(first) : graph.outside(first)));
      }
    }
  }
}

// The corners of a square lie on the sides of another one; a small one is within both.
void an_inscribed_part() {
  const Polygon around = square(0, 8), small = square(3, 4), inscribed = {{4, 0, 0}, {8, 4, 0}, {4, 8, 0}, {0, 4, 0}};
  for (const bool is_first : {true, false}) {
    const Polygons graph(is_first ? std::vector{inscribed, around, small} : std::vector{around, inscribed, small});
    const std::size_t of_inscribed = is_first ? 0 : 1;
    CHECK(graph.outside(2) == graph.inside(of_inscribed));
    CHECK(graph.outside(of_inscribed) == graph.inside(1 - of_inscribed));
  }
}

void points_on_segments() {
  const Polygons graph({square(0, 8), square(3, 4)});
  const auto face = [&](Vec3 p) { return graph.graph().face_at(point(p)); };
  CHECK(face({1, 1, 0}) == graph.inside(0));
  CHECK(face({3, 7, 0}) == graph.inside(0));  // beside a side of the small one
  CHECK(face({3.5, 3.25, 0}) == graph.inside(1));
  for (const Vec3 p : {Vec3{0, 1, 0}, {5, 8, 0}, {8, 8, 0}, {3, 3.5, 0}, {3.5, 4, 0}, {4, 3, 0}, {9, 8, 0}, {-1, 4, 0}}) CHECK(!face(p));
}

}  // namespace

UNIT(plane_graph) {
  parts_that_touch();
  an_inscribed_part();
  points_on_segments();
}
