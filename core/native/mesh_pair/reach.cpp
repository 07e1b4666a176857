// Branch and bound over pieces of triangles, the piece with the greatest upper bound first. A piece with corners v_i,
// centre c and radius r around c, s(x) being the distance to the surface of the solid, has no point farther from it than
//   max_i |v_i - T|   T the triangle nearest to c: the distance to a convex set is convex
//   s(c) + r          s is 1-Lipschitz
// If c is inside, no point of the piece is farther outside than r - s(c); if it is outside, none is deeper inside. The
// distance to a convex solid is largest at a corner, and to a nearly convex one larger by its defect at most.
#include "mesh_pair/reach.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "base/best_first.hpp"
#include "exact/triangle_distance.hpp"
#include "mesh/convexity.hpp"

namespace satcheck {
namespace {

// Measured steps of a piece, without the queries in it, and of the distance of two triangles.
constexpr std::uint64_t kPieceWork = 100, kTrianglesWork = 200;

// Pieces after which the bounds of a deviation are returned as they are.
constexpr std::size_t kMostPieces = 2'000'000;

// Roundings of a distance, in units of the largest coordinate.
constexpr double kDistanceError = 32 * std::numeric_limits<double>::epsilon();

// The defect of a mesh that counts as convex, in units of its largest coordinate.
constexpr double kConvex = 1e-13;

// How far a piece is pushed inwards, as a share of a bound that is wanted: room for rounding.
constexpr double kPush = 0.99;

struct ReachPiece {
  Vec3 centre;
  double radius = 0;
  double distance;  // of the centre from the surface
  double farthest;  // no point of the piece is farther from the surface
  std::uint32_t nearest;  // the triangle nearest to the centre
};

ReachPiece measured(const Corners& c, const Surface& solid, Budget& budget) {
  budget.spend(kPieceWork);
  ReachPiece piece{(c[0] + c[1] + c[2]) * (1.0 / 3), 0, 0, 0, 0};
  const NearestPoint nearest = nearest_point(solid, piece.centre, &budget);
  piece.distance = nearest.distance;
  piece.nearest = nearest.triangle;
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

// A member of the union. defect: no point of its hull is farther from it; infinite if it is not nearly convex. The rounding
// of a placement bends the faces of a convex mesh.
struct Member {
  const Surface& surface;
  double defect;
};

std::vector<Member> members_of(const std::vector<const Surface*>& solids) {
  std::vector<Member> members;
  for (const Surface* each : solids) {
    const double most = kConvex * each->bvh.nodes[0].box.largest_coordinate();
    members.push_back({*each, each->solid ? convexity_defect(each->mesh, most) : INFINITY});
  }
  return members;
}

bool is_inside(const Surface& surface, Vec3 p, Budget& budget) {
  // A point on the surface counts as inside. The distance is 0 in both cases.
  return surface.solid && winding_number(surface, p, &budget) != 0;
}

// The vector divided by its length; 0 stays 0.
Vec3 unit_of(Vec3 v) {
  const double length = norm(v);
  return length > 0 ? v * (1 / length) : v;
}

double distance_to(const Surface& surface, Vec3 p) {
  return std::sqrt(box_distance_squared({p, p}, surface.bvh.nodes[0].box));
}

class Outside {
 public:
  Outside(std::vector<Member> members, double tolerance, double ratio, Budget& budget)
      : members_(std::move(members)), tolerance_(tolerance), ratio_(ratio), budget_(budget) {}

  Deviation run(const Mesh& mesh) {
    point_ = mesh.vertices[mesh.triangles[0][0]];
    std::vector<bool> seen(mesh.vertices.size());
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t v : triangle) {
        if (!seen[v]) raise_lower(mesh.vertices[v]);
        seen[v] = true;
      }
    }
    if (members_.size() == 1 && std::isfinite(members_[0].defect)) {
      settled_ = lower_ + members_[0].defect;
    } else {
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) add(corners(mesh, t));
    }
    while (!open_.empty() && open_.key() > enough() && pieces_ < kMostPieces && !budget_.is_spent()) {
      const auto [one, other] = halves(open_.pop());
      raise_lower(one[1]);  // the new corner
      add(one);
      add(other);
    }
    const double open = open_.empty() ? 0.0 : open_.key();
    const double upper = std::fmax(lower_, std::fmax(open, settled_));
    double largest = bounds_of(mesh.vertices).largest_coordinate();
    for (const Member& each : members_) largest = larger(largest, each.surface.bvh.nodes[0].box.largest_coordinate());
    const double error = kDistanceError * largest;
    return {std::fmax(0.0, lower_ - error), upper == 0 ? 0.0 : upper + error, point_, open <= enough()};
  }

 private:
  double enough() const { return lower_ + std::fmax(tolerance_, ratio_ * lower_); }

  void add(const Corners& c) {
    ++pieces_;
    if (budget_.is_due()) budget_.tell(lower_, INFINITY);
    double upper = INFINITY;
    for (const Member& each : members_) {
      if (upper <= enough()) break;
      upper = std::fmin(upper, bound(c, each, upper));
    }
    if (upper > enough()) {
      raise_lower((c[0] + c[1] + c[2]) * (1.0 / 3));
      open_.push(upper, c);
    } else {
      settled_ = std::fmax(settled_, upper);
    }
  }

  // No point of the piece is farther from the member; or some number of at least `limit`.
  double bound(const Corners& c, const Member& member, double limit) {
    const Surface& surface = member.surface;
    for (const Vec3& v : c) {
      if (distance_to(surface, v) >= limit) return limit;
    }
    if (std::isfinite(member.defect)) return farthest_corner(c, surface) + member.defect;
    const ReachPiece piece = measured(c, surface, budget_);
    double upper = piece.farthest;
    if (!(upper > enough())) return upper;
    const bool inside = is_inside(surface, piece.centre, budget_);
    if (inside) upper = std::fmin(upper, std::fmax(0.0, piece.radius - piece.distance));
    if (!surface.solid) return upper;
    for (const double length : {enough(), upper / 4}) {
      for (const Corners& face : {corners(surface.mesh, piece.nearest), c}) {
        const bool may = length < upper && (inside || piece.distance <= length);
        if (may) upper = std::fmin(upper, pushed(c, piece.centre, face, surface, kPush * length));
      }
    }
    return upper;
  }

  double farthest_corner(const Corners& c, const Surface& convex) {
    double farthest = 0;
    for (const Vec3& v : c) {
      const double distance = nearest_point(convex, v, &budget_).distance;
      if (distance > farthest && !is_inside(convex, v, budget_)) farthest = distance;
    }
    return farthest;
  }

  // Moves the corners inwards by the length, behind the face and towards the centre. If the moved piece is inside, no point of the piece
  // is farther out than the longest move. So a face that lies in a face is settled at once.
  double pushed(const Corners& c, Vec3 centre, const Corners& face, const Surface& surface, double length) {
    const Vec3 out = unit_of(cross(face[1] - face[0], face[2] - face[0]));
    Corners moved = c;
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 way = unit_of(centre - c[i]) - out;
      moved[i] = c[i] + unit_of(way) * length;
      longest = std::fmax(longest, norm(moved[i] - c[i]));
    }
    const bool apart = visit_box(surface.bvh, surface.mesh, bounds_of(moved), [&](std::uint32_t t) {
      budget_.spend(kTrianglesWork);
      return classify(moved, corners(surface.mesh, t), &budget_) == TriangleContact::disjoint;
    }, &budget_);
    return apart && is_inside(surface, moved[0], budget_) ? longest : INFINITY;
  }

  void raise_lower(Vec3 v) {
    if (budget_.is_due()) budget_.tell(lower_, INFINITY);
    double distance = INFINITY;
    for (const Member& each : members_) {
      if (std::isfinite(each.defect) && is_inside(each.surface, v, budget_)) return;
    }
    for (const Member& each : members_) {
      if (distance_to(each.surface, v) < distance) distance = std::fmin(distance, nearest_point(each.surface, v, &budget_).distance);
      if (distance <= lower_) return;
    }
    for (const Member& each : members_) {
      if (!std::isfinite(each.defect) && is_inside(each.surface, v, budget_)) return;
    }
    lower_ = distance;
    point_ = v;
  }

  std::vector<Member> members_;
  double tolerance_, ratio_;
  Budget& budget_;
  double lower_ = 0, settled_ = 0;
  Vec3 point_;
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
    const ReachPiece piece = measured(c, solid_, budget_);
    if (piece.farthest <= length_) return false;
    const auto winding = winding_number(solid_, piece.centre, &budget_);
    if (winding && *winding != 0 && piece.distance > length_) return true;
    if (winding && *winding == 0 && (piece.radius - piece.distance <= length_ || !meets_surface(c))) return false;
    open_.push(piece.farthest, c);
    return false;
  }

  bool meets_surface(const Corners& c) {
    return !visit_box(solid_.bvh, solid_.mesh, bounds_of(c), [&](std::uint32_t t) {
      budget_.spend(kTrianglesWork);
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

Deviation deviation(const Mesh& surface_of, const std::vector<const Surface*>& solids, double tolerance, double ratio, Budget& budget) {
  if (!(tolerance > 0)) throw std::invalid_argument("the tolerance must be positive");
  bool empty = surface_of.triangles.empty() || solids.empty();
  for (const Surface* each : solids) empty = empty || each == nullptr || each->mesh.triangles.empty();
  if (empty) throw std::invalid_argument("the deviation of an empty mesh is not defined");
  return Outside(members_of(solids), tolerance, ratio, budget).run(surface_of);
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
