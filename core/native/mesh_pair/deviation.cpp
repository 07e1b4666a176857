// Branch and bound over pieces of triangles, the piece with the greatest upper bound first. Bounds
// of a piece with corners v_i, centre c and radius r around c, s(x) being the distance to the
// surface of the solid and d(x) <= s(x) the one to the solid:
//   d <= d(c) + r              d is 1-Lipschitz
//   d <= r - s(c)              when c is inside
//   d <= max_i |v_i - T|       T the triangle nearest to c: the distance to a convex set is convex
#include "mesh_pair/deviation.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <stdexcept>
#include <vector>

#include "mesh_pair/reach.hpp"

namespace satcheck {
namespace {

// Evaluations after which the bounds are returned as they are.
constexpr std::size_t kMaxEvaluations = 2'000'000;

// Roundings of a distance, in units of the largest coordinate.
constexpr double kDistanceError = 32 * std::numeric_limits<double>::epsilon();

struct Piece {
  Corners corners;
  double upper;
};

class Search {
 public:
  Search(const Surface& solid, double tolerance) : solid_(solid), tolerance_(tolerance) {}

  Deviation run(const Mesh& mesh) {
    double largest = 0;
    for (const Mesh* m : {&mesh, &solid_.mesh}) {
      for (const Vec3& p : m->vertices) largest = std::fmax(largest, max_abs(p));
    }
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) add(corners(mesh, t));
    while (!pieces_.empty() && pieces_.top().upper > lower_ + tolerance_ && evaluations_ < kMaxEvaluations) {
      const Corners c = pieces_.top().corners;
      pieces_.pop();
      for (const Corners& half : halves(c)) add(half);
    }
    const double rest = pieces_.empty() ? 0.0 : pieces_.top().upper;
    const double upper = std::fmax(lower_, std::fmax(rest, settled_));
    const double error = kDistanceError * largest;
    return {std::fmax(0.0, lower_ - error), upper == 0 ? 0.0 : upper + error};
  }

 private:
  void add(const Corners& c) {
    ++evaluations_;
    const NearPiece piece(solid_, c, nullptr);
    const double to_surface = piece.nearest.distance;
    double upper = std::fmin(piece.to_triangle, to_surface + piece.radius);
    // The inside test matters only for pieces that could raise the result.
    if (upper > lower_ + tolerance_) {
      if (is_inside(piece.centre)) {
        upper = std::fmin(upper, std::fmax(0.0, piece.radius - to_surface));
      } else {
        lower_ = std::fmax(lower_, to_surface);
        for (const Vec3& v : c) raise_lower(v);
      }
    }
    if (upper > lower_ + tolerance_) {
      pieces_.push({c, upper});
    } else {
      settled_ = std::fmax(settled_, upper);
    }
  }

  void raise_lower(Vec3 v) {
    const double distance = nearest_point(solid_, v).distance;
    if (distance > lower_ && !is_inside(v)) lower_ = distance;
  }

  // A point on the surface counts as inside. The distance is 0 in both cases.
  bool is_inside(Vec3 p) const { return solid_.solid && winding_number(solid_, p) != 0; }

  struct LowerFirst {
    bool operator()(const Piece& a, const Piece& b) const { return a.upper < b.upper; }
  };

  const Surface& solid_;
  double tolerance_;
  double lower_ = 0, settled_ = 0;
  std::size_t evaluations_ = 0;
  std::priority_queue<Piece, std::vector<Piece>, LowerFirst> pieces_;
};

}  // namespace

Deviation deviation(const Mesh& surface_of, const Surface& solid, double tolerance) {
  if (!(tolerance > 0)) throw std::invalid_argument("the tolerance must be positive");
  if (surface_of.triangles.empty() || solid.mesh.triangles.empty()) {
    throw std::invalid_argument("the deviation of an empty mesh is not defined");
  }
  return Search(solid, tolerance).run(surface_of);
}

}  // namespace satcheck
