// A mesh with the data for queries, built once and shared between queries and threads.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/mesh.hpp"
#include "mesh/bvh.hpp"
#include "mesh/facing.hpp"

namespace satcheck {

struct Closing;
class Outline;
struct Surface;

// Two interpretations of an open surface. filled: each hole has some unknown fill. sheets: parts with a rim are
// intended to be open and have no inside; other holes are filled.
enum class OpenParts : std::uint8_t { filled, sheets };

// The closings of an open surface, for both interpretations. The first thread that needs one makes it.
struct LazyClosings {
  std::mutex mutex;
  std::shared_ptr<const Closing> made[2];
  std::shared_ptr<const Surface> walled[2];
};

// What is the same of an open surface wherever its vertices lie. The first thread that needs it makes it.
struct LazyRims {
  std::once_flag has_loops, has_loose;
  std::vector<std::vector<std::uint32_t>> loops;  // boundary_loops() of the surface whose sheets are doubled
  std::vector<std::uint32_t> loose;               // the triangles without an inside if open parts are sheets
};

// The outline of a prism (mesh/outline.hpp). The first thread that needs it makes it.
struct LazyOutline {
  std::once_flag once;
  std::shared_ptr<const Outline> made;
};

struct Surface {
  // welded: is not changed; others may share it.
  explicit Surface(std::shared_ptr<const Mesh> welded) : owned(std::move(welded)), mesh(*owned) {}

  std::shared_ptr<const Mesh> owned;
  const Mesh& mesh;
  Bvh bvh;
  std::vector<std::uint32_t> parts;  // a triangle of each part that is connected through common vertices
  // Closed: every edge is run as often in one direction as in the other, so every point has a winding number. No part faces
  // inward or is doubtful.
  bool solid = false;
  // Triangles of open parts that lie in one plane or are intended to be open. They stay sheets even if the rounding of
  // a placement bends them.
  std::vector<std::uint32_t> sheets;
  Facing facing;  // of a surface that is no solid; the rounding of a placement does not change it
  bool refitted = false;  // the tree has the form of another surface's
  OpenParts open_parts = OpenParts::filled;
  std::shared_ptr<LazyRims> rims = std::make_shared<LazyRims>();
  std::shared_ptr<LazyClosings> closings = std::make_shared<LazyClosings>();
  std::shared_ptr<LazyOutline> outline = std::make_shared<LazyOutline>();
};

// The closing of the open surface (mesh/boundary.hpp). Made once. budget: of the query that asks, which is polled meanwhile
// and pays nothing.
std::shared_ptr<const Closing> closing_of(const Surface& open, OpenParts parts, Budget* budget = nullptr);

// The closed surface with the hulls of its holes as additional walls. Points that these walls do not separate from a
// point outside of all hulls are inside or outside like that point, for every fill. Made once.
std::shared_ptr<const Surface> walled_surface(const Surface& open, OpenParts parts);

// solid: it is known to be one. Throws std::invalid_argument if it is true for a surface that is not closed.
Surface make_surface(const Mesh& mesh, bool solid, OpenParts open = OpenParts::filled);

// The same for a mesh from inspect() whose topology is a plain solid. This is not proven again. region: of all queries,
// see build_bvh_near(); null: anywhere.
Surface make_plain_surface(std::shared_ptr<const Mesh> inspected, const Aabb* region = nullptr);

// The surface of `mesh`, which is the mesh of `like` after an affine map; a mirror flips the winding. Nothing is
// sorted: the tree of `like` is fitted again. If the triangles differ, or if rounding has merged two vertices, the
// surface is built from scratch.
Surface refitted_surface(const Surface& like, Mesh mesh);

// Winding number of a point with respect to a solid; empty if the point is on the surface.
std::optional<int> winding_number(const Surface& surface, Vec3 point, Budget* budget = nullptr);

// A canonical order of two surfaces: their boxes are compared, then all vertices and triangles. True for two equal meshes.
// Scaling by powers of two does not change the result. A query is always answered in this order, and its answer is
// mirrored for the other one. So rounding and the order of triangles affect A against B and B against A in the same way.
bool comes_before(const Surface& a, const Surface& b);

struct NearestPoint {
  double distance;
  Vec3 point;
  std::uint32_t triangle;
};

// The point of the surface nearest to p, by branch and bound over its tree, in float64. near: of a triangle that is likely to
// be near to p. Throws std::invalid_argument on an empty surface.
NearestPoint nearest_point(const Surface& surface, Vec3 p, Budget* budget = nullptr, const NearestPoint* near = nullptr);

// The distance of the surface from the line of the points with the coordinates x and y along two unit vectors that are
// perpendicular to it and to each other. In float64.
double line_distance(const Surface& surface, Vec3 u, Vec3 v, double x, double y, Budget* budget = nullptr);

}  // namespace satcheck
