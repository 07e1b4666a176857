// Which features meet, by name, and where: rounded once, whatever the names.
#include "mesh/incidence.hpp"

#include <cmath>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

MeshFeature vertex(std::uint32_t v) { return {v, v}; }
MeshFeature inside(std::uint32_t t) { return {MeshFeature::kInside, t}; }

const Mesh kFloor{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};

TriangleMeeting on_floor(Vec3 p, Vec3 q, Vec3 r) {
  return meet_triangles(kFloor, 0, Mesh{{p, q, r}, {{0, 1, 2}}}, 0);
}

void transversal() {
  const TriangleMeeting m = on_floor({1, 1, -1}, {1, 1, 1}, {9, 9, 1});
  CHECK(m.kind == MeetingKind::segment);
  CHECK((m.nodes[0] == Incidence{MeshFeature::edge(1, 2), inside(0)}));
  CHECK((m.nodes[1] == Incidence{inside(0), MeshFeature::edge(0, 1)}));
}

void a_vertex_has_one_name() {
  const TriangleMeeting in = on_floor({1, 1, 0}, {1, 1, 5}, {2, 1, 5});
  CHECK(in.kind == MeetingKind::point && (in.nodes[0] == Incidence{inside(0), vertex(0)}));
  const TriangleMeeting edge = on_floor({2, 0, 0}, {1, 1, 5}, {2, 1, 5});
  CHECK(edge.kind == MeetingKind::point && (edge.nodes[0] == Incidence{MeshFeature::edge(0, 1), vertex(0)}));
  const TriangleMeeting corner = on_floor({4, 0, 0}, {9, 1, 5}, {9, 2, 5});
  CHECK(corner.kind == MeetingKind::point && (corner.nodes[0] == Incidence{vertex(1), vertex(0)}));
}

void coplanar() {
  const TriangleMeeting m = on_floor({1, 1, 0}, {9, 1, 0}, {1, 9, 0});
  CHECK(m.kind == MeetingKind::patch && !m.opposed);
  CHECK(m.nodes.size() == 3 && m.sides.size() == 3);
  const TriangleMeeting turned = on_floor({1, 1, 0}, {1, 9, 0}, {9, 1, 0});
  CHECK(turned.kind == MeetingKind::patch && turned.opposed);
  const TriangleMeeting beside = on_floor({0, 0, 0}, {1, -1, 0}, {4, 0, 0});
  CHECK(beside.kind == MeetingKind::segment);
}

// Every side of a patch starts where another one ends.
void sides_go_around() {
  const TriangleMeeting m = on_floor({-1, 1, 0}, {3, -1, 0}, {3, 3, 0});
  CHECK(m.sides.size() == 6);
  for (const MeetingSide& side : m.sides) {
    int follows = 0;
    for (const MeetingSide& next : m.sides) follows += next.from == side.to;
    CHECK(follows == 1);
  }
}

void a_point_is_rounded_once() {
  // A third has no float64: the nearest one, however the point is named.
  const Mesh wall{{{1, 1, -1}, {1, 1, 2}, {1, -9, 2}}, {{0, 1, 2}}};
  const Mesh slope{{{0, 0, 0}, {3, 0, 1}, {0, 3, 0}}, {{0, 1, 2}}};
  const ExactPoint p = locate({MeshFeature::edge(0, 1), inside(0)}, wall, slope);
  CHECK((p.rounded == Vec3{1, 1, 1.0 / 3}));
  const ExactPoint swapped = locate({inside(0), MeshFeature::edge(0, 1)}, slope, wall);
  CHECK(swapped.rounded == p.rounded);
}

void straightness_is_exact() {
  const auto at = [](double x, double y) {
    return locate({vertex(0), vertex(0)}, Mesh{{{x, y, 0}}, {}}, Mesh{});
  };
  const double ulp = std::nextafter(2.0, 3.0) - 2.0;
  CHECK(straight(at(0, 0), at(1, 1), at(2, 2)));
  CHECK(!straight(at(0, 0), at(1, 1), at(2, 2 + ulp)));
  CHECK(!straight(at(0, 0), at(2, 2), at(1, 1)));
}

}  // namespace

UNIT(incidence) {
  transversal();
  a_vertex_has_one_name();
  coplanar();
  sides_go_around();
  a_point_is_rounded_once();
  straightness_is_exact();
}
