// The data derived from the mesh of a body, in file and in world coordinates. Each is made once, by the first thread
// that needs it.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "ladder/oriented_box.hpp"
#include "mesh/hull_points.hpp"
#include "mesh/surface.hpp"
#include "mesh/transform.hpp"

namespace satcheck {

// The data that all bodies with one mesh share, in file coordinates.
class Geometry {
 public:
  // solid: the mesh is closed and consistently wound. If that is false, surfaces throw std::invalid_argument.
  // plain: the mesh is the output of inspect(), which proved that it is a plain solid. That is not proven again.
  // open: what the open parts of its surface mean. Throws std::invalid_argument for a mesh without vertices.
  Geometry(std::shared_ptr<Mesh> mesh, bool solid, bool plain = false, OpenParts open = OpenParts::filled);

  const std::shared_ptr<Mesh>& mesh() const { return mesh_; }
  bool solid() const { return solid_; }
  bool plain() const { return plain_; }
  const Aabb& bounds();

  // Closed, consistently outward, and exactly convex. An affine map keeps a mesh convex up to the rounding of each
  // world coordinate, so the body in the world is the hull of its world vertices.
  bool convex();
  std::optional<bool> known_convex() const;

  std::shared_ptr<Surface> surface();
  // The surface for queries about this region. The mesh must be plain. The result is not kept.
  std::shared_ptr<Surface> surface_near(const Aabb& region);
  // budget: is spent on hulls that are not made yet.
  std::shared_ptr<Polytope> hull(Budget* budget = nullptr);
  std::shared_ptr<Shape> hull_shape(Budget* budget = nullptr);
  std::shared_ptr<HullPoints> hull_points(Budget* budget = nullptr);

  // The surface of the placed mesh.
  std::shared_ptr<Surface> surface_of(Mesh placed);

  // How many trees were built, and how many were fitted again to placed vertices.
  std::size_t hierarchies() const { return hierarchies_; }
  std::size_t refits() const { return refits_; }

 private:
  std::shared_ptr<Mesh> mesh_;
  bool solid_, plain_;
  OpenParts open_;
  mutable std::recursive_mutex mutex_;  // of all below
  std::optional<Aabb> bounds_;
  std::optional<bool> convex_;
  std::shared_ptr<Surface> surface_;
  std::shared_ptr<Polytope> hull_;
  std::shared_ptr<Shape> hull_shape_;
  std::shared_ptr<HullPoints> hull_points_;
  std::atomic<std::size_t> hierarchies_{0}, refits_{0};
};

// One body in the world. Its data can be released and are made again on demand.
class PlacedGeometry {
 public:
  // transform: affine and not singular; empty: the identity. around: the bounds of a shape that its mesh lies in; empty:
  // those of the mesh. resolution: the precision of its coordinates, world units.
  PlacedGeometry(std::shared_ptr<Geometry> shared, std::optional<Matrix> transform, std::optional<Aabb> around, double resolution)
      : shared_(std::move(shared)), transform_(transform), around_(around), resolution_(resolution) {}

  Geometry& shared() const { return *shared_; }
  // Throws what transform() throws, and std::invalid_argument if the mesh does not lie in the bounds around it.
  const Aabb& bounds();
  double resolution() const { return resolution_; }

  std::shared_ptr<Mesh> mesh();  // each coordinate rounded once
  bool placed_as_in_file() const { return !transform_; }
  std::shared_ptr<Surface> surface();
  std::shared_ptr<Polytope> hull(Budget* budget = nullptr);      // of all vertices, with its faces
  std::shared_ptr<Shape> hull_shape(Budget* budget = nullptr);   // the same as a shape, usually without faces
  // The box of the mesh in the file, moved by the transform. It contains every point within `pad` of the body.
  OrientedBox oriented_box(double pad);

  void release();

 private:
  std::shared_ptr<Geometry> shared_;
  std::optional<Matrix> transform_;
  std::optional<Aabb> around_;
  double resolution_;
  std::once_flag bounded_;
  Aabb bounds_;
  std::recursive_mutex mutex_;  // of all below
  std::shared_ptr<Mesh> mesh_;
  std::shared_ptr<Surface> surface_;
  std::shared_ptr<Polytope> hull_;
  std::shared_ptr<Shape> hull_shape_;
};

}  // namespace satcheck
