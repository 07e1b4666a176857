#include "thickness/cell_cut.hpp"

#include <cmath>

namespace satcheck {
namespace {

// Cells with more corners are split along the axes only.
constexpr std::size_t kManyCorners = 28;
// A void next to more patches is not split off.
constexpr std::size_t kFewPatches = 12;
// Axes and planes that explain less than this share of a gap do not explain it.
constexpr double kExplained = 0.1;
// A side of a cell that is steeper than this along an axis bounds the way along it.
constexpr double kSteep = 1e-9;

class Chooser {
 public:
  explicit Chooser(const CellGap& gap) : gap_(gap), cell_(gap.cell), at_mean_(sum_at(gap.mean)) {}

  std::optional<HalfSpace> choose(double least) {
    const double whole = gap_at_corners();
    if (whole < least) return std::nullopt;
    for (const Vec3 axis : gap_.axes.row) take(gap_along(axis), [&] { return halving(axis); });
    const bool few_corners = cell_.corners.size() <= kManyCorners;
    if (few_corners) take_planes();
    if (most_ >= kExplained * whole) return cut_;
    cut_.reset();
    most_ = gap_.bodies.rounding();
    if (few_corners) take_edges();
    return cut_;
  }

 private:
  template <class Cut>
  void take(double explained, Cut cut) {
    if (!(explained > most_)) return;
    most_ = explained;
    cut_ = cut();
  }

  const Patch& patch_of(const CellGap::Term& term) const { return gap_.bodies.patch(term.column.body, term.column.patch); }
  Vec3 origin_of(const CellGap::Term& term) const { return gap_.bodies.patches(term.column.body).origin(patch_of(term)); }

  double sum_at(Vec3 p) const {
    double sum = 0;
    for (const CellGap::Term& term : gap_.terms) sum += term.weight * gap_.bodies.value(term.column, p);
    gap_.budget.spend(kDistanceWork * gap_.terms.size());
    return sum;
  }

  HalfSpace halving(Vec3 along) const { return {along, cell_.along(along).middle()}; }

  // By how much the mean over the two ends of the way through the cell along an axis is above the value at the mean.
  double gap_along(Vec3 along) const {
    double forward = INFINITY, backward = INFINITY;
    for (const HalfSpace& side : cell_.sides) {
      const double slope = dot(side.normal, along), room = std::fmax(side.height - dot(side.normal, gap_.mean), 0.0);
      if (slope > kSteep) forward = smaller(forward, room / slope);
      if (slope < -kSteep) backward = smaller(backward, room / -slope);
    }
    if (!(forward < INFINITY && backward < INFINITY && forward + backward > gap_.bodies.rounding())) return 0;
    const double share = backward / (forward + backward);
    return share * sum_at(gap_.mean + along * forward) + (1 - share) * sum_at(gap_.mean - along * backward) - at_mean_;
  }

  double gap_at_corners() const {
    double gap = -at_mean_;
    for (std::size_t k = 0; k < cell_.corners.size(); ++k) {
      if (gap_.shares[k] > 0) gap += gap_.shares[k] * sum_at(cell_.corners[k].at);
    }
    return gap;
  }

  void take_planes() {
    for (const CellGap::Term& term : gap_.terms) {
      const Patch& patch = patch_of(term);
      take(gap_at_plane(term), [&] { return HalfSpace{patch.normal, dot(patch.normal, origin_of(term))}; });
    }
  }

  // The same because the patch's plane runs through the cell.
  double gap_at_plane(const CellGap::Term& term) const {
    const Patch& patch = patch_of(term);
    double sum = 0, sum_of_sizes = 0;
    for (std::size_t k = 0; k < cell_.corners.size(); ++k) {
      const double s = gap_.shares[k] * dot(patch.normal, cell_.corners[k].at - origin_of(term));
      sum += s;
      sum_of_sizes += std::fabs(s);
    }
    return term.weight * (sum_of_sizes - std::fabs(sum));
  }

  void take_edges() {
    for (const CellGap::Term& term : gap_.terms) {
      const Patch& patch = patch_of(term);
      const Vec3* outline = gap_.bodies.patches(term.column.body).outlines.data() + patch.first;
      for (std::uint32_t i = 0; i < patch.count; ++i) {
        const Vec3 out = cross(outline[(i + 1) % patch.count] - outline[i], patch.normal);
        const double length = norm(out);
        if (!(length > 0)) continue;
        const HalfSpace within{out * (1 / length), dot(out, outline[i]) / length};
        take(term.weight * gap_beyond(within), [&] { return within; });
      }
    }
  }

  // How far corners lie beyond the plane; 0 where all do.
  double gap_beyond(const HalfSpace& plane) const {
    double sum = 0;
    bool divides = false;
    for (std::size_t k = 0; k < cell_.corners.size(); ++k) {
      const double beyond = dot(plane.normal, cell_.corners[k].at) - plane.height;
      sum += gap_.shares[k] * std::fmax(beyond, 0.0);
      divides = divides || beyond < -gap_.bodies.rounding();
    }
    return divides ? sum : 0;
  }

  const CellGap& gap_;
  const Cell& cell_;
  double at_mean_;
  double most_ = 0;  // of the gap, explained by the cut
  std::optional<HalfSpace> cut_;
};

}  // namespace

std::optional<HalfSpace> cut_at_gap(const CellGap& gap, double least) { return Chooser(gap).choose(least); }

std::optional<HalfSpace> cut_off_void(const Cell& cell, const ConvexPatches& patches, const PatchList& met, Vec3 point,
                                      double layer, Budget& budget) {
  if (met.size() > kFewPatches || cell.corners.size() > kManyCorners) return std::nullopt;
  double distance = INFINITY;
  Vec3 on_wall;
  budget.spend(kDistanceWork * met.size());
  for (const std::uint32_t i : met) {
    const Vec3 nearest = patches.nearest(patches.patches[i], point);
    if (norm(point - nearest) >= distance) continue;
    distance = norm(point - nearest);
    on_wall = nearest;
  }
  if (!(distance > 4 * layer && distance < INFINITY)) return std::nullopt;
  const Vec3 towards = (point - on_wall) * (1 / distance);
  return HalfSpace{towards, dot(towards, on_wall) + layer};
}

}  // namespace satcheck
