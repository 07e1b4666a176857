// Flat convex pieces of a surface: triangles that lie in one plane and together are convex.
#pragma once

#include <vector>

#include "mesh/surface.hpp"

namespace satcheck {

struct Patch {
  Vec3 normal;          // unit; zero for a triangle without area
  std::uint32_t first;  // place of its outline in `outlines`
  std::uint32_t count;  // corners of its outline
  std::uint32_t first_triangle, triangle_count;  // place in `triangles`
  double slack;  // no point of the patch is farther from its triangles, beside rounding
};

struct ConvexPatches {
  std::vector<Patch> patches;
  std::vector<Vec3> outlines;            // counter-clockwise seen from the side of the normal
  std::vector<std::uint32_t> triangles;  // numbers in the mesh
  std::vector<std::uint32_t> patch_of;   // each triangle of the mesh; kNoIndex: none
  std::vector<Aabb> boxes;               // of each patch, where they are few; empty: not kept

  Aabb box(std::uint32_t number) const { return boxes.empty() ? box_of(patches[number]) : boxes[number]; }
  Vec3 origin(const Patch& patch) const { return outlines[patch.first]; }  // a corner
  // The distance from p to the patch, rounded: never below the true one by more than rounding.
  double distance(const Patch& patch, Vec3 p) const { return norm(nearest(patch, p) - p); }
  // A point of the patch, the nearest one up to rounding.
  Vec3 nearest(const Patch& patch, Vec3 p) const;
  Aabb box_of(const Patch& patch) const;
};

// Of these triangles. flatness: patches may deviate from a plane by this length.
ConvexPatches convex_patches(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, double flatness);

}  // namespace satcheck
