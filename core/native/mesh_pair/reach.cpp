// Branch and bound over pieces of triangles, the piece with the greatest upper bound first. A piece with corners v_i,
// centre c and radius r around c, s(x) being the distance to the surface of the solid, has no point farther from it than
//   max_i |v_i - T|   T the triangle nearest to c: the distance to a convex set is convex
//   s(c) + r          s is 1-Lipschitz
// If c is inside, no point of the piece is farther outside than r - s(c); if it is outside, none is deeper inside.
#include "mesh_pair/reach.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "base/best_first.hpp"
#include "exact/triangle_distance.hpp"

namespace satcheck {
namespace {

// Measured steps of a piece, without the queries in it, and of the distance of two triangles.
constexpr std::uint64_t kPieceWork = 100, kTriangleWork = 200;

// Pieces after which the bounds of a deviation are returned as they are.
constexpr std::size_t kMostPieces = 2'000'000;

// Roundings of a distance, in units of the largest coordinate.
constexpr double kDistanceError = 32 * std::numeric_limits<double>::epsilon();

struct Piece {
  Vec3 centre;
  double radius = 0;
  double distance;  // of the centre from the surface
  double farthest;  // no point of the piece is farther from the surface
};

Piece measured(const Corners& c, const Surface& solid, Budget& budget) {
  budget.spend(kPieceWork);
  Piece piece{(c[0] + c[1] + c[2]) * (1.0 / 3), 0, 0, 0};
  const NearestPoint nearest = nearest_point(solid, piece.centre, &budget);
  piece.distance = nearest.distance;
  const Corners target = corners(solid.mesh, nearest.triangle);
  double to_nearest = 0;
  for (const Vec3& v : c) {
    piece.radius = std::fmax(piece.radius, norm(v - piece.centre));
    to_nearest = std::fmax(to_nearest, norm(nearest_on_triangle(v, target) - v));
  }
  piece.farthest = std::fmin(to_nearest, nearest.distance + piece.radius);
  return piece;
}

std::array<Corners, 2> halves(const Corners& c) {
  int longest = 0;
  for (int i = 1; i < 3; ++i) {
    if (norm_squared(c[(i + 1) % 3] - c[i]) > norm_squared(c[(longest + 1) % 3] - c[longest])) longest = i;
  }
  const Vec3 p = c[longest], q = c[(longest + 1) % 3], apex = c[(longest + 2) % 3], middle = p * 0.5 + q * 0.5;
  return {Corners{p, middle, apex}, Corners{middle, q, apex}};
}

class Outside {
 public:
  Outside(const Surface& solid, double tolerance, Budget& budget) : solid_(solid), tolerance_(tolerance), budget_(budget) {}

  Deviation run(const Mesh& mesh) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) add(corners(mesh, t));
    while (!open_.empty() && open_.key() > lower_ + tolerance_ && pieces_ < kMostPieces) {
      for (const Corners& half : halves(open_.pop())) add(half);
    }
    const double upper = std::fmax(lower_, std::fmax(open_.empty() ? 0.0 : open_.key(), settled_));
    const double largest = larger(bounds_of(mesh.vertices).largest_coordinate(), bounds_of(solid_.mesh.vertices).largest_coordinate());
    const double error = kDistanceError * largest;
    return {std::fmax(0.0, lower_ - error), upper == 0 ? 0.0 : upper + error};
  }

 private:
  void add(const Corners& c) {
    ++pieces_;
    const Piece piece = measured(c, solid_, budget_);
    double upper = piece.farthest;
    // The inside test matters only for pieces that could raise the result.
    if (upper > lower_ + tolerance_) {
      if (is_inside(piece.centre)) {
        upper = std::fmin(upper, std::fmax(0.0, piece.radius - piece.distance));
      } else {
        lower_ = std::fmax(lower_, piece.distance);
        for (const Vec3& v : c) raise_lower(v);
      }
    }
    if (upper > lower_ + tolerance_) {
      open_.push(upper, c);
    } else {
      settled_ = std::fmax(settled_, upper);
    }
  }

  void raise_lower(Vec3 v) {
    const double distance = nearest_point(solid_, v, &budget_).distance;
    if (distance > lower_ && !is_inside(v)) lower_ = distance;
  }

  // A point on the surface counts as inside. The distance is 0 in both cases.
  bool is_inside(Vec3 p) const { return solid_.solid && winding_number(solid_, p, &budget_) != 0; }

  const Surface& solid_;
  double tolerance_;
  Budget& budget_;
  double lower_ = 0, settled_ = 0;
  std::size_t pieces_ = 0;
  BestFirst<Corners> open_;
};

class Inside {
 public:
  // No point outside of the solid's box, made smaller by the length, is deeper.
  Inside(const Surface& solid, double length, Budget& budget)
      : solid_(solid), length_(length), core_(solid.bvh.nodes[0].box.widened(-length)), budget_(budget) {}

  bool reaches(const Mesh& mesh) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (reaches(corners(mesh, t))) return true;
    }
    while (!open_.empty()) {
      for (const Corners& half : halves(open_.pop())) {
        if (reaches(half)) return true;
      }
    }
    return false;
  }

 private:
  // Whether a point of the piece does for certain. Opens the piece if one may.
  bool reaches(const Corners& c) {
    if (!meet(bounds_of(c), core_)) return false;
    const Piece piece = measured(c, solid_, budget_);
    if (piece.farthest <= length_) return false;
    const auto winding = winding_number(solid_, piece.centre, &budget_);
    if (winding && *winding != 0 && piece.distance > length_) return true;
    if (winding && *winding == 0 && (piece.radius - piece.distance <= length_ || !meets_surface(c))) return false;
    open_.push(piece.farthest, c);
    return false;
  }

  bool meets_surface(const Corners& c) {
    return !visit_box(solid_.bvh, solid_.mesh, bounds_of(c), [&](std::uint32_t t) {
      budget_.spend(kTriangleWork);
      return triangle_distance(c, corners(solid_.mesh, t), &budget_).distance_squared != 0;
    }, &budget_);
  }

  const Surface& solid_;
  double length_;
  Aabb core_;
  Budget& budget_;
  BestFirst<Corners> open_;
};

}  // namespace

Deviation deviation(const Mesh& surface_of, const Surface& solid, double tolerance, Budget& budget) {
  if (!(tolerance > 0)) throw std::invalid_argument("the tolerance must be positive");
  if (surface_of.triangles.empty() || solid.mesh.triangles.empty()) {
    throw std::invalid_argument("the deviation of an empty mesh is not defined");
  }
  return Outside(solid, tolerance, budget).run(surface_of);
}

std::optional<bool> reaches_deeper(const Mesh& surface_of, const Surface& solid, double length, Budget& budget) {
  if (solid.bvh.nodes.empty()) return false;
  try {
    return Inside(solid, length, budget).reaches(surface_of);
  } catch (const BudgetSpent&) {
    return std::nullopt;
  }
}

}  // namespace satcheck
