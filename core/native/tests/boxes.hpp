// Solids that are unions of boxes with whole coordinates, and slow truths about them by their cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/shapes.hpp"

namespace satcheck::testing {

struct WholeBox {
  int low[3], high[3];

  bool holds_cell(int x, int y, int z) const {
    return low[0] <= x && x < high[0] && low[1] <= y && y < high[1] && low[2] <= z && z < high[2];
  }
};
using WholeBoxes = std::vector<WholeBox>;

inline Mesh mesh_of(const WholeBoxes& boxes) {
  Mesh mesh;
  for (const WholeBox& b : boxes) {
    append(mesh, box({b.low[0] * 1.0, b.low[1] * 1.0, b.low[2] * 1.0}, {b.high[0] * 1.0, b.high[1] * 1.0, b.high[2] * 1.0}));
  }
  return mesh;
}

// `count` boxes within the cube from 0 to `size`. Their faces often lie in each other.
inline WholeBoxes random_boxes(std::mt19937& generator, int count, int size) {
  WholeBoxes boxes(static_cast<std::size_t>(count));
  for (WholeBox& b : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      b.low[axis] = std::uniform_int_distribution<int>(0, size - 1)(generator);
      b.high[axis] = std::uniform_int_distribution<int>(b.low[axis] + 1, size)(generator);
    }
  }
  return boxes;
}

inline bool cell_in(const WholeBoxes& boxes, int x, int y, int z) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const WholeBox& b) { return b.holds_cell(x, y, z); });
}

}  // namespace satcheck::testing
