// The table of corners: those of equal coordinates, bit for bit, are one vertex.
#include "corners.hpp"

#include <vector>

#include "tests/check.hpp"

namespace {

using namespace satcheck::scene;

}  // namespace

UNIT(corners) {
  const Corners<float>::Point points[] = {{0, 0, 1}, {0, -0.f, 1}, {0, 0, 1}, {2, 3, 4}};
  Corners<float> table(0);
  std::vector<double> vertices;
  std::vector<std::uint32_t> numbers;
  for (const auto& point : points) {
    numbers.push_back(table.number(point, table.hash(&point), vertices));
  }
  CHECK((numbers == std::vector<std::uint32_t>{0, 1, 0, 2}));
  CHECK(vertices.size() == 9);
}
