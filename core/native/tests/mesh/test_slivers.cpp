// Collinear triangles go, the surface stays.
#include "mesh/slivers.hpp"

#include <algorithm>
#include <map>

#include "base/edge_table.hpp"
#include "exact/predicates.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;

namespace {

std::size_t slivers(const Mesh& mesh) {
  return static_cast<std::size_t>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    const auto& at = mesh.vertices;
    return !repeats_a_corner(t) && collinear(at[t[0]], at[t[1]], at[t[2]]);
  }));
}

// Every edge as often one way as the other.
bool closed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Triangle& t : mesh.triangles) {
    if (repeats_a_corner(t)) continue;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t u = t[i], v = t[(i + 1) % 3];
      balance[std::minmax(u, v)] += u < v ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

// Splits triangle t at a point of its first edge, and closes the gap with a sliver.
void split(Mesh& mesh, std::uint32_t t, double at) {
  const auto [u, v, x] = mesh.triangles[t];
  const auto m = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(mesh.vertices[u] * (1 - at) + mesh.vertices[v] * at);
  mesh.triangles[t] = {u, m, x};
  mesh.triangles.push_back({m, v, x});
  mesh.triangles.push_back({u, v, m});
}

void no_slivers_no_change() {
  const Mesh mesh = testing::box({0, 0, 0}, {1, 2, 3});
  const Sliverless result = without_slivers(mesh);
  CHECK(!result.changed);
  CHECK(result.mesh.triangles == mesh.triangles);
}

void slivers_beside_slivers() {
  Mesh mesh = testing::box({0, 0, 0}, {4, 4, 4});
  double at = 0.5;  // a different point each time, for vertices must not coincide
  for (const std::uint32_t t : {0u, 0u, 5u, 13u, 13u, 15u}) split(mesh, t, at *= 0.5);
  CHECK(slivers(mesh) >= 6 && closed(mesh));
  const double volume = signed_volume(mesh.vertices, mesh.triangles);
  const Sliverless result = without_slivers(mesh);
  CHECK(result.changed);
  CHECK(slivers(result.mesh) == 0);
  CHECK(closed(result.mesh));
  CHECK(signed_volume(result.mesh.vertices, result.mesh.triangles) == volume);
  CHECK(result.source.size() == mesh.triangles.size());
}

void a_lone_sliver_stays() {
  const Mesh wire{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  CHECK(without_slivers(wire).mesh.triangles == wire.triangles);
}

}  // namespace

UNIT(slivers) {
  no_slivers_no_change();
  slivers_beside_slivers();
  a_lone_sliver_stays();
}
