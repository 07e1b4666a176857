// Translated surfaces, whose trees are not built again.
#pragma once

#include <memory>
#include <optional>

#include "mesh/boundary.hpp"
#include "mesh/surface.hpp"

namespace satcheck {

// A surface that is translated many times.
class MovedSurface {
 public:
  // `still` must outlive this.
  explicit MovedSurface(const Surface& still)
      : still_(still), moved_mesh_(std::make_shared<Mesh>(still.mesh)), moved_(moved_mesh_) {
    moved_.bvh = {still.bvh.nodes, still.bvh.order, {}};  // a box of a triangle is made when one is asked for
    moved_.parts = still.parts;
    moved_.solid = still.solid;
    moved_.open_parts = still.open_parts;
    moved_.sheets = still.sheets;
    moved_.outline = nullptr;  // it would not follow the moves
    if (!still.solid) closed_ = std::make_shared<MovedSurface>(*closing_of(still, OpenParts::filled)->surface);
  }

  // The surface as it was moved last.
  Surface take() && {
    moved_.outline = std::make_shared<LazyOutline>();
    return std::move(moved_);
  }

  // The surface with t added to every coordinate, rounded once. Rounding keeps the order of coordinates, so the moved
  // boxes contain the moved triangles exactly. Valid until the next call.
  const Surface& at(Vec3 t, Budget* budget = nullptr) {
    if (still_.solid && t == at_) return moved_;
    at_ = t;
    for (std::size_t i = 0; i < still_.mesh.vertices.size(); ++i) {
      moved_mesh_->vertices[i] = still_.mesh.vertices[i] + t;
    }
    for (std::size_t i = 0; i < still_.bvh.nodes.size(); ++i) {
      const Aabb& box = still_.bvh.nodes[i].box;
      moved_.bvh.nodes[i].box = {box.min + t, box.max + t};
    }
    if (!still_.solid) moved_.closings = moved_closings(t, budget);
    return moved_;
  }

 private:
  std::shared_ptr<LazyClosings> moved_closings(Vec3 t, Budget* budget) {
    const Closing& still = *closing_of(still_, OpenParts::filled);
    const std::shared_ptr<const Surface> closed{closed_, &closed_->at(t, budget)};
    auto closings = std::make_shared<LazyClosings>();
    // The boxes of the holes are not moved: only their size is used.
    closings->made[static_cast<std::size_t>(OpenParts::filled)] =
        std::make_shared<const Closing>(Closing{closed, still.holes, hulls_of(*moved_mesh_, still.holes, budget)});
    return closings;
  }

  const Surface& still_;
  std::shared_ptr<Mesh> moved_mesh_;
  Surface moved_;
  std::optional<Vec3> at_;  // where it is
  std::shared_ptr<MovedSurface> closed_;  // of an open surface
};

// The surface with t added to every coordinate. If rounding has merged two vertices, it is built from scratch.
Surface translated_surface(const Surface& still, Vec3 t);

// A point near the meshes that can be subtracted from all their coordinates without rounding; 0 along an axis on which
// the meshes are near the origin. Relative to it, coordinates are small: moving them rounds less, and far fewer signs
// need exact arithmetic.
Vec3 exact_centre(const Surface& a, const Surface& b);

// Two surfaces, moved by that point if it is not 0.
class NearOrigin {
 public:
  // Both must outlive this.
  NearOrigin(const Surface& of_a, const Surface& of_b)
      : centre(exact_centre(of_a, of_b)), a(near(moved_a_, of_a)), b(near(moved_b_, of_b)) {}
  NearOrigin(const NearOrigin&) = delete;
  NearOrigin& operator=(const NearOrigin&) = delete;

 private:
  const Surface& near(std::optional<MovedSurface>& moved, const Surface& surface) {
    return centre == Vec3{} ? surface : moved.emplace(surface).at(-centre);
  }

  std::optional<MovedSurface> moved_a_, moved_b_;

 public:
  const Vec3 centre;
  const Surface &a, &b;
};

}  // namespace satcheck
