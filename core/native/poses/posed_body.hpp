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

class PosedBody {
 public:
  // A body with a mesh.
  explicit PosedBody(std::shared_ptr<Geometry> geometry);
  // Another body: it lies in the hull of `corners`, grown by `margin`, and these balls lie in it.
  PosedBody(const std::vector<Vec3>& corners, double margin, std::vector<Ball> inner);

  const VertexLanes& corners() const { return corners_; }
  double margin() const { return margin_; }
  const Ball& around() const { return around_; }          // holds the body
  Vec3 largest() const { return largest_; }               // |coordinate| of all corners
  bool has_mesh() const { return geometry_ != nullptr; }
  // Of the mesh, in file coordinates. Made by the first call, like the two below.
  const Surface& surface();
  // The same with the hulls of all holes. Points that it does not separate are in the body, or none is, for any fill.
  const Surface& walls();
  // Whether a point on none of the walls is in the material, or may be in the fill of a hole.
  bool may_hold(Vec3 point);
  // Balls in the material, the largest first. Made by the first call; empty for a mesh that is not solid.
  const std::vector<Ball>& inner();
  // The largest ball in the material of a solid mesh about a point in it; empty for other bodies and points.
  std::optional<Ball> ball_about(Vec3 point) const;

 private:
  void enclose(const std::vector<Vec3>& corners);

  std::shared_ptr<Geometry> geometry_;
  VertexLanes corners_;
  double margin_ = 0;
  Ball around_;
  Vec3 largest_;
  std::once_flag has_surface_, has_walls_, has_inner_;
  std::shared_ptr<Surface> surface_;
  std::shared_ptr<const Surface> walls_;
  std::vector<Ball> inner_;
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

}  // namespace satcheck
