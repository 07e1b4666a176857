// Steps that all readers share: stopping with a reason, adding vertices and polygons, final checks.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "read_result.hpp"

namespace satcheck::scene {

// Readers stop by throwing a ReadError; `run_reader` turns it into the outcome, so none escapes a room.
[[noreturn]] inline void fail_at_line(const char* code, std::string message, std::int64_t line) {
  throw ReadError{code, std::move(message), line, nowhere};
}
[[noreturn]] inline void fail_at_byte(const char* code, std::string message, std::int64_t offset) {
  throw ReadError{code, std::move(message), nowhere, offset};
}
[[noreturn]] inline void fail(const char* code, std::string message) {
  throw ReadError{code, std::move(message), nowhere, nowhere};
}

template <class Reader>
ReadOutcome run_reader(Reader reader) {
  try {
    return reader();
  } catch (ReadError& error) {
    return std::move(error);
  }
}

// Vertex numbers are stored in 32 bits.
constexpr std::int64_t max_vertices = std::numeric_limits<std::uint32_t>::max();

// Polygons, cut into triangles as a fan from the first vertex; those with fewer than three vertices
// are counted and reported once.
class Polygons {
 public:
  void add(const std::vector<std::uint32_t>& corners, std::int64_t place, MeshData& mesh) {
    if (corners.size() < 3) {
      if (too_short_++ == 0) first_short_ = place;
      return;
    }
    for (std::size_t i = 2; i < corners.size(); ++i) {
      mesh.triangles.push_back(corners[0]);
      mesh.triangles.push_back(corners[i - 1]);
      mesh.triangles.push_back(corners[i]);
    }
  }

  // `unit` names what `place` counted: "line", "face".
  void report(const char* unit, MeshData& mesh) const {
    if (too_short_ == 0) return;
    mesh.warnings.push_back({code::short_face, std::to_string(too_short_) +
                                                   (too_short_ == 1 ? " face has" : " faces have") +
                                                   " fewer than 3 vertices and was ignored (first: " + unit +
                                                   " " + std::to_string(first_short_) + ")"});
  }

 private:
  std::int64_t too_short_ = 0;
  std::int64_t first_short_ = 0;
};

inline void require_triangles(const MeshData& mesh) {
  if (!mesh.triangles.empty()) return;
  fail(code::empty_mesh, mesh.vertices.empty() ? "empty mesh: no vertices and no triangles"
                                               : "empty mesh: " + std::to_string(mesh.vertices.size() / 3) +
                                                     " vertices but no triangles");
}

}  // namespace satcheck::scene
