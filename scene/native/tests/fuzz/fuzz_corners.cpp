// The vertex numbers of corners, against an ordered map.
#include <map>

#include "corners.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace satcheck::scene;

template <class Coordinate>
void number_all(Input input) {
  using Point = typename Corners<Coordinate>::Point;
  Corners<Coordinate> corners(0);
  std::map<std::array<char, sizeof(Point)>, std::uint32_t> known;
  std::vector<double> vertices;
  while (!input.rest().empty()) {
    const Point point = input.next<Point>();
    const auto first = known.try_emplace(std::bit_cast<std::array<char, sizeof(Point)>>(point), known.size()).first;
    require(corners.number(point, corners.hash(&point), vertices) == first->second);
  }
  require(vertices.size() == 3 * known.size());
}

}  // namespace

FUZZ_TARGET(corners) {
  number_all<float>(Input(data));
  number_all<double>(Input(data));
}
