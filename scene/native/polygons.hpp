// Polygons of a file, cut into triangles that cover them.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/budget.hpp"
#include "read_result.hpp"

namespace satcheck::scene {

// Polygons with fewer than three corners are counted and reported once. A polygon that names vertices which come later
// in the file is cut at the end.
class Polygons {
 public:
  // place: of the polygon in the file, for messages.
  void add(const std::vector<std::uint32_t>& corners, std::int64_t place, MeshData& mesh) {
    if (corners.size() == 3) {
      mesh.triangles.insert(mesh.triangles.end(), corners.begin(), corners.end());
    } else {
      add_other(corners, place, mesh);
    }
  }

  // Cuts what is left, and warns. `unit` names what `place` counted: "line", "face".
  void finish(const char* unit, MeshData& mesh);

 private:
  void add_other(const std::vector<std::uint32_t>& corners, std::int64_t place, MeshData& mesh);

  std::int64_t too_short_ = 0;
  std::int64_t first_short_ = 0;
  std::vector<std::pair<std::vector<std::uint32_t>, std::size_t>> waiting_;  // with the number of their objects
  Budget budget_;  // of cutting, all polygons of the file together
};

}  // namespace satcheck::scene
