// Solids that are unions of boxes with whole coordinates, and slow truths about them by their cells.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <random>
#include <utility>
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

// Cells of a lattice of `size` cells a side, one after another along z, then y, then x.
struct Cells {
  int size;
  std::vector<bool> filled;

  bool operator()(int x, int y, int z) const {
    const auto within = [this](int c) { return 0 <= c && c < size; };
    return within(x) && within(y) && within(z) && filled[static_cast<std::size_t>((x * size + y) * size + z)];
  }
};

// Each cell is filled with this probability. Such solids have caves, and meet themselves along edges and at corners.
inline Cells random_cells(std::mt19937& generator, int size, double probability) {
  Cells cells{size, std::vector<bool>(static_cast<std::size_t>(size * size * size))};
  std::bernoulli_distribution filled(probability);
  for (std::size_t k = 0; k < cells.filled.size(); ++k) cells.filled[k] = filled(generator);
  return cells;
}

// The boundary of the cells, outward, as rectangles of a random cut. Their edges meet in T-junctions. A vertex is
// common to all that have it as a corner.
inline Mesh rectangles_of(const Cells& cells, std::mt19937& generator) {
  using Point = std::array<int, 3>;
  Mesh mesh;
  std::map<Point, std::uint32_t> numbers;
  const auto vertex = [&](const Point& p) {
    const auto [at, is_new] = numbers.try_emplace(p, static_cast<std::uint32_t>(numbers.size()));
    if (is_new) mesh.vertices.push_back({p[0] * 1.0, p[1] * 1.0, p[2] * 1.0});
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      std::map<Point, bool> left;  // squares, each by the cell below it
      for (int k = 0; k < cells.size * cells.size * cells.size; ++k) {
        const Point cell{k / (cells.size * cells.size), k / cells.size % cells.size, k % cells.size};
        Point next = cell;
        next[axis] += upper ? 1 : -1;
        if (cells(cell[0], cell[1], cell[2]) && !cells(next[0], next[1], next[2])) left[cell] = true;
      }
      while (!left.empty()) {
        const Point first = std::next(left.begin(), static_cast<std::ptrdiff_t>(generator() % left.size()))->first;
        std::vector<Point> taken{first};
        std::array<int, 3> sides{1, 1, 1};
        std::array<std::size_t, 2> along{(axis + 1) % 3, (axis + 2) % 3};
        if (generator() % 2 != 0) std::swap(along[0], along[1]);
        for (const std::size_t a : along) {
          for (std::vector<Point> row = taken;; ++sides[a]) {
            for (Point& p : row) p[a] = first[a] + sides[a];
            if (!std::all_of(row.begin(), row.end(), [&](const Point& p) { return left.count(p) != 0; })) break;
            taken.insert(taken.end(), row.begin(), row.end());
          }
        }
        for (const Point& p : taken) left.erase(p);
        std::array<std::uint32_t, 4> corner;
        for (int k = 0; k < 4; ++k) {
          Point p = first;
          p[axis] += upper;
          p[(axis + 1) % 3] += k == 1 || k == 2 ? sides[(axis + 1) % 3] : 0;
          p[(axis + 2) % 3] += k == 2 || k == 3 ? sides[(axis + 2) % 3] : 0;
          corner[static_cast<std::size_t>(upper ? k : 3 - k)] = vertex(p);
        }
        mesh.triangles.push_back({corner[0], corner[1], corner[2]});
        mesh.triangles.push_back({corner[0], corner[2], corner[3]});
      }
    }
  }
  return mesh;
}

// The boundary of the cells, outward, with common vertices.
inline Mesh boundary_of(const Cells& cells) {
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> numbers;
  const auto vertex = [&](const std::array<int, 3>& p) {
    const auto [at, is_new] = numbers.try_emplace(p, static_cast<std::uint32_t>(numbers.size()));
    if (is_new) mesh.vertices.push_back({p[0] * 1.0, p[1] * 1.0, p[2] * 1.0});
    return at->second;
  };
  for (int x = 0; x < cells.size; ++x)
    for (int y = 0; y < cells.size; ++y)
      for (int z = 0; z < cells.size; ++z) {
        if (!cells(x, y, z)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const bool upper : {false, true}) {
            std::array<int, 3> next{x, y, z};
            next[axis] += upper ? 1 : -1;
            if (cells(next[0], next[1], next[2])) continue;
            std::array<std::uint32_t, 4> corner;
            for (int k = 0; k < 4; ++k) {
              std::array<int, 3> p{x, y, z};
              p[axis] += upper;
              p[(axis + 1) % 3] += k == 1 || k == 2;
              p[(axis + 2) % 3] += k == 2 || k == 3;
              corner[static_cast<std::size_t>(upper ? k : 3 - k)] = vertex(p);
            }
            mesh.triangles.push_back({corner[0], corner[1], corner[2]});
            mesh.triangles.push_back({corner[0], corner[2], corner[3]});
          }
      }
  return mesh;
}

}  // namespace satcheck::testing
