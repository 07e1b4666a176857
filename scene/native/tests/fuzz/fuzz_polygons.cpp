// Polygons among a few points, most of them on a small grid, so that corners repeat and lie in a line.
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/target.hpp"
#include "polygons.hpp"

namespace {

using namespace satcheck::scene;

MeshData points(Input& input) {
  MeshData mesh;
  const std::size_t count = 3 + input.next<std::uint8_t>() % 60;
  const bool on_a_grid = input.next<std::uint8_t>() % 4 != 0;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    const double c = on_a_grid ? input.next<std::int8_t>() : input.next<double>();
    mesh.vertices.push_back(std::isfinite(c) ? c : 0);
  }
  return mesh;
}

}  // namespace

FUZZ_TARGET(polygons) {
  Input input(data);
  MeshData mesh = points(input);
  Polygons polygons;
  std::vector<std::uint32_t> corners;
  std::size_t expected = 0;
  const auto add = [&] {
    if (corners.size() >= 3) expected += corners.size() - 2;
    polygons.add(corners, 1, mesh);
    corners.clear();
  };
  const std::size_t count = mesh.vertices.size() / 3;
  for (const char c : input.rest()) {
    const auto value = static_cast<std::uint8_t>(c);
    if (value == 0xff) {
      add();
    } else {
      corners.push_back(value % static_cast<std::uint32_t>(count));
    }
  }
  add();
  polygons.finish("face", mesh);
  require(mesh.triangles.size() == 3 * expected);  // n - 2 for n corners, however a polygon is cut
  if (!mesh.triangles.empty()) check(mesh);
}
