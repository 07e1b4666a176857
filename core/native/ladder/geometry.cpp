#include "convex/convex_hull.hpp"
#include "mesh/transform.hpp"
#include "ladder/geometry.hpp"

#include <stdexcept>

#include "mesh/convexity.hpp"

namespace satcheck {
namespace {

using Lock = std::lock_guard<std::recursive_mutex>;

template <class T, class Make>
std::shared_ptr<T> once(std::recursive_mutex& mutex, std::shared_ptr<T>& kept, Make make) {
  const Lock lock(mutex);
  if (!kept) kept = std::make_shared<T>(make());
  return kept;
}

}  // namespace

Geometry::Geometry(std::shared_ptr<Mesh> mesh, bool solid, bool plain, OpenParts open)
    : mesh_(std::move(mesh)), solid_(solid), plain_(plain), open_(open) {
  if (mesh_->vertices.empty()) throw std::invalid_argument("an empty mesh is no body");
}

const Aabb& Geometry::bounds() {
  const Lock lock(mutex_);
  if (!bounds_) {
    bounds_ = bounds_of(mesh_->vertices);
  }
  return *bounds_;
}

bool Geometry::convex() {
  const Lock lock(mutex_);
  if (!convex_) convex_ = solid_ && convexity_defect(*mesh_, 0.0) == 0.0;
  return *convex_;
}

std::optional<bool> Geometry::known_convex() const {
  const Lock lock(mutex_);
  return convex_;
}

std::shared_ptr<Surface> Geometry::surface() {
  return once(mutex_, surface_, [&] {
    ++hierarchies_;
    if (plain_) return make_plain_surface(mesh_);
    return make_surface(*mesh_, solid_, open_);
  });
}

std::shared_ptr<Surface> Geometry::surface_near(const Aabb& region) {
  ++hierarchies_;
  return std::make_shared<Surface>(make_plain_surface(mesh_, &region));
}

std::shared_ptr<Polytope> Geometry::hull(Budget* budget) {
  return once(mutex_, hull_, [&] { return convex_hull(mesh_->vertices, budget); });
}

std::shared_ptr<Shape> Geometry::hull_shape(Budget* budget) {
  return once(mutex_, hull_shape_, [&] { return make_hull(*hull(budget)); });
}

std::shared_ptr<HullPoints> Geometry::hull_points(Budget* budget) {
  return once(mutex_, hull_points_, [&] { return find_hull_points(*mesh_, budget); });
}

std::shared_ptr<Surface> Geometry::surface_of(Mesh placed) {
  auto fitted = std::make_shared<Surface>(refitted_surface(*surface(), std::move(placed)));
  ++(fitted->refitted ? refits_ : hierarchies_);
  return fitted;
}

const Aabb& PlacedGeometry::bounds() {
  std::call_once(bounded_, [&] {
    const Aabb box = transform_ ? placed_bounds(*shared_->mesh(), *transform_) : shared_->bounds();
    if (around_ && !around_->contains(box)) throw std::invalid_argument("the bounds do not hold the mesh as it is placed");
    bounds_ = around_.value_or(box);
  });
  return bounds_;
}

std::shared_ptr<Mesh> PlacedGeometry::mesh() {
  if (!transform_) return shared_->mesh();
  return once(mutex_, mesh_, [&] { return transform(*shared_->mesh(), *transform_); });
}

std::shared_ptr<Surface> PlacedGeometry::surface() {
  if (!transform_) return shared_->surface();
  const Lock lock(mutex_);
  if (!surface_) surface_ = shared_->surface_of(mesh_ ? *mesh_ : transform(*shared_->mesh(), *transform_));
  return surface_;
}

std::shared_ptr<Polytope> PlacedGeometry::hull(Budget* budget) {
  if (!transform_) return shared_->hull(budget);
  return once(mutex_, hull_, [&] { return convex_hull(mesh()->vertices, budget); });
}

std::shared_ptr<Shape> PlacedGeometry::hull_shape(Budget* budget) {
  if (!transform_) return shared_->hull_shape(budget);
  return once(mutex_, hull_shape_, [&] {
    auto placed = placed_hull(*shared_->hull_points(budget), *transform_);
    return placed ? std::move(*placed) : make_hull(*hull(budget));
  });
}

OrientedBox PlacedGeometry::oriented_box(double pad) {
  if (!transform_) return carried_box(bounds(), nullptr, pad);
  return carried_box(shared_->bounds(), &*transform_, pad);
}

void PlacedGeometry::release() {
  const Lock lock(mutex_);
  mesh_.reset();
  surface_.reset();
  hull_.reset();
  hull_shape_.reset();
}

}  // namespace satcheck
