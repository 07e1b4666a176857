#include "thickness/face_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "base/rounding.hpp"
#include "base/budget.hpp"
#include "exact/triangle_pair.hpp"
#include "thickness/strip_cell.hpp"

namespace satcheck {
namespace {

constexpr std::uint64_t kClipWork = 60, kMeetWork = 4, kPlaceWork = 50;
// A cell with more triangles is divided at once.
constexpr std::size_t kManyPieces = 200;
// Regions reach beyond their cells by these shares, tried in turn: strips that meet on a wall of a cell, or a little
// beyond it, meet within one of them, or do not both reach into another.
constexpr double kBeyond[] = {0.06, 0.0, 0.4};
constexpr double kFarthest = 0.4;
// What is computed about places of points is off by less than this many roundoffs of the scale.
constexpr double kPlaceRoundoffs = 1024;

// low, high: along the axes.
struct Placed {
  int body;
  std::uint32_t number;
  std::array<double, 3> low, high;
};

struct StripCell {
  std::array<double, 3> low, high;
  std::vector<const Placed*> near;  // that meet the largest region of the cell
};

class Proof {
 public:
  Proof(const Surface& a, const Surface& b, double length, Budget& budget)
      : surfaces_{&a, &b}, half_(length / 2), budget_(budget) {
    budget_.spend(kPlaceWork * (a.mesh.triangles.size() + b.mesh.triangles.size()));
    for (const Surface* surface : surfaces_) {
      scale_ = larger(scale_, surface->bvh.nodes[0].box.largest_coordinate());
    }
    rounding_ = kPlaceRoundoffs * kUnitRoundoff * scale_;
    find_axes();
    place_triangles();
  }

  FaceFit run() {
    std::vector<StripCell> open{root()};
    bool thick_bodies = true;
    while (!open.empty()) {
      if (budget_.is_spent()) return FaceFit::open;
      StripCell cell = std::move(open.back());
      open.pop_back();
      const StripResult result = judged(cell);
      if (result.answer == StripAnswer::deeper) return FaceFit::deeper;
      if (result.answer == StripAnswer::thin) {
        thick_bodies = thick_bodies && result.thick_bodies;
      } else if (!divide(cell, result.cut, open)) {
        return FaceFit::open;
      }
    }
    return thick_bodies ? FaceFit::fit : FaceFit::thin;
  }

 private:
  // Along the largest triangle, and the largest one across it.
  void find_axes() {
    Vec3 first, second;
    double most = 0;
    const auto each = [&](auto&& take) {
      for (const Surface* surface : surfaces_) {
        for (std::uint32_t t = 0; t < surface->mesh.triangles.size(); ++t) {
          const Corners c = corners(surface->mesh, t);
          take(cross(c[1] - c[0], c[2] - c[0]));
        }
      }
    };
    each([&](Vec3 normal) {
      if (norm(normal) > most) first = normal, most = norm(normal);
    });
    if (!(most > 0)) return;
    first = first * (1 / most);
    most = 0;
    each([&](Vec3 normal) {
      const Vec3 flat = normal - first * dot(first, normal);
      const double size = norm(normal);
      if (size > most && norm(flat) > 0.5 * size) second = flat, most = size;
    });
    if (!(most > 0)) second = any_perpendicular(first);
    second = second * (1 / norm(second));
    axes_ = {{first, second, cross(first, second)}};
  }

  StripCell root() const {
    StripCell cell;
    for (std::size_t k = 0; k < 3; ++k) {
      double low = -INFINITY, high = INFINITY;
      for (const Surface* surface : surfaces_) {
        double least = INFINITY, most = -INFINITY;
        for (const Vec3 v : surface->mesh.vertices) {
          const double at = dot(axes_.row[k], v);
          least = smaller(least, at);
          most = larger(most, at);
        }
        low = larger(low, least);
        high = smaller(high, most);
      }
      cell.low[k] = low - rounding_;
      cell.high[k] = larger(high, low) + rounding_;
    }
    for (const Placed& triangle : triangles_) cell.near.push_back(&triangle);
    return cell;
  }

  void place_triangles() {
    for (int body = 0; body < 2; ++body) {
      const Mesh& mesh = surfaces_[static_cast<std::size_t>(body)]->mesh;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        Placed placed{body, t, {INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        for (const Vec3 corner : corners(mesh, t)) {
          for (std::size_t k = 0; k < 3; ++k) {
            const double at = dot(axes_.row[k], corner);
            placed.low[k] = smaller(placed.low[k], at);
            placed.high[k] = larger(placed.high[k], at);
          }
        }
        triangles_.push_back(placed);
      }
    }
  }

  StripRegion region(const StripCell& cell, double share) const {
    StripRegion region{axes_, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const double beyond = share * (cell.high[k] - cell.low[k]) + 4 * half_ + rounding_;
      region.low[k] = cell.low[k] - beyond;
      region.high[k] = cell.high[k] + beyond;
    }
    return region;
  }

  bool meets(const Placed& triangle, const StripRegion& region) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (triangle.low[k] > region.high[k] + rounding_ || triangle.high[k] < region.low[k] - rounding_) return false;
    }
    return true;
  }

  StripResult judged(StripCell& cell) {
    const StripRegion largest = region(cell, kFarthest);
    budget_.spend(kMeetWork * cell.near.size());
    std::erase_if(cell.near, [&](const Placed* triangle) { return !meets(*triangle, largest); });
    StripResult result;
    for (const double share : kBeyond) {
      const StripRegion around = region(cell, share);
      std::vector<StripPiece> pieces;
      for (const Placed* triangle : cell.near) {
        if (!meets(*triangle, around)) continue;
        budget_.spend(kClipWork);
        const int body = triangle->body;
        StripPiece piece = clipped(*surfaces_[static_cast<std::size_t>(body)], body, triangle->number, around, scale_);
        if (!piece.shares.empty()) pieces.push_back(std::move(piece));
        if (pieces.size() > kManyPieces) return {};
      }
      result = judge_strips(*surfaces_[0], *surfaces_[1], around, pieces, half_, scale_, budget_);
      if (result.answer != StripAnswer::divide || result.cut) break;
    }
    return result;
  }

  bool divide(const StripCell& cell, std::optional<StripCut> cut, std::vector<StripCell>& open) const {
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (cell.high[k] - cell.low[k] > cell.high[axis] - cell.low[axis]) axis = k;
    }
    if (cell.high[axis] - cell.low[axis] <= 64 * half_ + 16 * rounding_) return false;
    double at = (cell.low[axis] + cell.high[axis]) / 2;
    if (cut) {
      const auto k = static_cast<std::size_t>(cut->axis);
      if (cut->at > cell.low[k] && cut->at < cell.high[k]) axis = k, at = cut->at;
    }
    StripCell low = cell, high = cell;
    low.high[axis] = high.low[axis] = at;
    open.push_back(std::move(low));
    open.push_back(std::move(high));
    return true;
  }

  std::array<const Surface*, 2> surfaces_;
  double half_, scale_ = 0, rounding_ = 0;
  Budget& budget_;
  Mat3 axes_;
  std::vector<Placed> triangles_;
};

}  // namespace

FaceFit fit_by_faces(const Surface& a, const Surface& b, double length, Budget& budget) {
  if (!a.solid || !b.solid) throw std::invalid_argument("the thickness of an overlap needs two solids");
  if (!(length > 0)) throw std::invalid_argument("the length must be positive");
  if (a.bvh.nodes.empty() || b.bvh.nodes.empty()) return FaceFit::fit;
  return comes_before(a, b) ? Proof(a, b, length, budget).run() : Proof(b, a, length, budget).run();
}

}  // namespace satcheck
