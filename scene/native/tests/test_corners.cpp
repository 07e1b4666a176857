// The table of corners: no file can be made of corners whose hashes are equal, because they differ from table to table.
#include "corners.hpp"

#include <vector>

#include "tests/check.hpp"

namespace {

using namespace satcheck::scene;

}  // namespace

UNIT(corners) {
  const Corners<float>::Point points[] = {{0, 0, 1}, {0, -0.f, 1}, {0, 0, 1}, {2, 3, 4}};
  Corners<float> one(0), other(0);
  std::vector<double> vertices;
  std::vector<std::uint32_t> numbers;
  for (const auto& point : points) {
    CHECK(one.hash(&point) != other.hash(&point));
    numbers.push_back(one.number(point, one.hash(&point), vertices));
  }
  CHECK((numbers == std::vector<std::uint32_t>{0, 1, 0, 2}));
  CHECK(vertices.size() == 9);
}
