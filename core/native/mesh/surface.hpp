// A mesh with what queries need of it, built once and shared between queries and threads.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/mesh.hpp"
#include "mesh/bvh.hpp"

namespace satcheck {

struct Closing;
struct Surface;

// Two ways to read an open surface. filled: each hole is filled somehow. sheets: what has a rim is meant to be open,
// and has no inside; other holes are filled.
enum class OpenParts : std::uint8_t { filled, sheets };

// How an open surface is closed, in each of the two ways; made by the first thread that needs it.
struct LazyClosings {
  std::mutex mutex;
  std::shared_ptr<const Closing> made[2];
  std::shared_ptr<const Surface> walled[2];
};

struct Surface {
  // welded: as it stays; others may hold it too.
  explicit Surface(std::shared_ptr<const Mesh> welded) : owned(std::move(welded)), mesh(*owned) {}

  std::shared_ptr<const Mesh> owned;
  const Mesh& mesh;
  Bvh bvh;
  std::vector<std::uint32_t> parts;  // a triangle of each part that is connected through common vertices
  // Closed: every edge is run as often in one direction as in the other, so every point has a winding number.
  bool solid = false;
  // Triangles of open parts that lie in one plane, or that are meant to be open. Rounding may bend them where the
  // surface is placed; they stay sheets.
  std::vector<std::uint32_t> sheets;
  bool refitted = false;  // the tree has the form of another surface's
  OpenParts open_parts = OpenParts::filled;
  std::shared_ptr<LazyClosings> closings = std::make_shared<LazyClosings>();
};

// How the open surface is closed (mesh/closing.hpp). Made once.
std::shared_ptr<const Closing> closing_of(const Surface& open, OpenParts parts);

// The open surface closed, with the hulls of its holes as further walls. What these do not part from a point
// outside of all hulls is inside or outside as that point is, whatever fills the holes. Made once.
std::shared_ptr<const Surface> walled_surface(const Surface& open, OpenParts parts);

// Throws std::invalid_argument when `solid` is claimed of a surface that is not closed.
Surface make_surface(const Mesh& mesh, bool solid, OpenParts open = OpenParts::filled);

// The same of a mesh as inspect() left it, whose topology was that of a plain solid: nothing is proven again.
// region: where queries will be, as build_bvh_near() takes it; nothing: anywhere.
Surface make_plain_surface(std::shared_ptr<const Mesh> inspected, const Aabb* region = nullptr);

// The surface of `mesh`, which is that of `like` with its vertices elsewhere, as an affine map puts them;
// a mirror turns the winding. Nothing is sorted: the tree of `like` is fitted again. Where the triangles
// are others, or rounding has put two vertices into one place, the surface is made anew.
Surface refitted_surface(const Surface& like, Mesh mesh);

// Winding number of a point with respect to a solid; nothing when the point is on the surface.
std::optional<int> winding_number(const Surface& surface, Vec3 point);

inline std::array<Vec3, 3> corners(const Mesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

}  // namespace satcheck
