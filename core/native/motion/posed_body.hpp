// A body that takes many poses. What it keeps in file coordinates proves, without its triangles in the world, that it is
// apart from another body, or that both have a deep point in common.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "convex/support_scan.hpp"
#include "ladder/geometry.hpp"

namespace satcheck {

struct Ball {
  Vec3 centre;
  double radius = 0;
};

// How an affine placement changes lengths: by a factor between the two, rounding included. least is 0 if nothing is
// known.
struct Stretch {
  double least = 0, most = 0;
};

// An open surface with its holes filled. distance: a lower bound of that of any two vertices.
struct FilledHoles {
  std::shared_ptr<const Closing> closing;
  double distance = 0;
};

class PosedBody {
 public:
  // A body with a mesh.
  explicit PosedBody(std::shared_ptr<Geometry> geometry);
  // A curved body: it lies in the hull of `corners`, grown by `margin`, and between two closed meshes.
  PosedBody(const std::vector<Vec3>& corners, double margin, std::shared_ptr<Geometry> around,
            std::shared_ptr<Geometry> within);

  const VertexLanes& corners() const { return corners_; }
  // Points of the body: its corners, or those of the mesh within a curved one. Made by the first call.
  const VertexLanes& own_corners();
  double margin() const { return margin_; }
  const Ball& around() const { return around_; }          // holds the body
  Vec3 largest() const { return largest_; }               // |coordinate| of all corners and vertices
  bool has_mesh() const { return geometry_ == within_; }
  // Of the mesh, or of that around a curved body, in file coordinates. Made by the first call, like those below.
  const Surface& surface();
  // The same with the hulls of all holes. Two points that it does not separate are both in the body or both outside, for
  // any fill.
  const Surface& walls();
  // A closed surface that holds only material: of a solid mesh, or within a curved body. Null for an open mesh.
  const Surface* material();
  // Whether a point on none of the walls is in the material, or may be in the fill of a hole.
  bool may_hold(Vec3 point);
  // Whether a point is in the material without any fill; empty for a point on the surface.
  std::optional<bool> encloses(Vec3 point);
  // Of an open mesh.
  const FilledHoles& filled();
  // Balls in the material, the largest first; empty for an open mesh.
  const std::vector<Ball>& inner();

 private:
  void enclose(const std::vector<Vec3>& corners);
  void widen(Vec3 p);  // largest()

  std::shared_ptr<Geometry> geometry_, within_;
  VertexLanes corners_, own_corners_;
  double margin_ = 0;
  Ball around_;
  Vec3 largest_;
  std::once_flag has_own_corners_, has_surface_, has_material_, has_walls_, has_inner_, has_filled_;
  std::shared_ptr<Surface> surface_, material_;
  std::shared_ptr<const Surface> walls_;
  std::vector<Ball> inner_;
  FilledHoles filled_;
};

// A body in one pose.
struct PosedPlace {
  Mat3 linear;
  Vec3 offset;
  Stretch stretch;
  double reach = 0;  // bounds the sum of |terms| of the three coordinates of any corner; infinite: proves nothing
  Ball around;       // in the world
};

// matrix: 12 numbers, three rows of four.
PosedPlace place_at(const PosedBody& body, const double* matrix);

// Balls within those that the placement makes of them.
Ball in_world(const PosedPlace& at, const Ball& ball);
std::vector<Ball> in_world(const PosedPlace& at, const std::vector<Ball>& balls);

// The point that the placement takes near `p`.
Vec3 in_file(const PosedPlace& at, Vec3 p);

}  // namespace satcheck
