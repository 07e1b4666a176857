// Clifford Hildreth, "A quadratic programming procedure" (1957): for one wall after another, move its two bodies apart,
// or back, until the wall is just kept. A wall never moves them back by more than it has moved them apart so far. Every
// step is lengthened, after Colin W. Cryer, "The solution of a quadratic programming problem using systematic
// overrelaxation" (1971), which suits chains of bodies.
#include "ladder/least_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angle.hpp"

namespace satcheck {
namespace {

constexpr int sweeps_at_most = 20000;
// If the shortfall does not halve within this many sweeps, the walls count as contradictory.
constexpr int patience = 2000;
// Shares of the longest way that a wall requires. converged: a sweep that changes less is the last one. overshoot: if
// sweeps_at_most sweeps were not enough, the goal is this far beyond the walls.
constexpr double converged = 0x1p-46, overshoot = 1e-6;
// Sweeps without overrelaxation. Perpendicular walls are kept exactly after the first one.
constexpr int plain_sweeps = 8;
// Chains longer than this are rare.
constexpr std::size_t longest_chain = 12;

class Solver {
 public:
  Solver(const std::vector<bool>& movable, const std::vector<PairWall>& walls, std::vector<double> multipliers)
      : walls_(walls), movable_(movable), at_(movable.size()), multipliers_(std::move(multipliers)) {
    for (std::size_t k = 0; k < walls.size(); ++k) {
      unit_ = std::max(unit_, std::fabs(walls[k].least));
      push(walls[k], multipliers_[k]);
    }
    const auto chain = static_cast<double>(std::min(walls.size(), longest_chain));
    relaxation_ = 2 / (1 + cosine_of(std::numbers::pi / 2 - std::numbers::pi / (2 * chain + 1)));
  }

  LeastMotion solve() {
    if (!settles(0)) settles(overshoot * unit_);
    return {std::move(at_), std::move(multipliers_)};
  }

 private:
  // Sweeps until nothing changes; with a margin, until all walls are kept.
  bool settles(double margin) {
    double before = shortfall();
    for (int sweep = 1; sweep <= sweeps_at_most; ++sweep) {
      const double relaxation = sweep <= plain_sweeps ? 1 : relaxation_;
      if (change_of_sweep(margin, relaxation, sweep % 2 == 0) <= converged * unit_) return true;
      if (margin > 0 && shortfall() <= 0) return true;
      if (sweep % patience == 0) {
        const double now = shortfall();
        if (now > 0.5 * before) return false;
        before = now;
      }
    }
    return false;
  }

  double change_of_sweep(double margin, double relaxation, bool backwards) {
    double change = 0;
    const std::size_t count = walls_.size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t number = backwards ? count - 1 - k : k;
      const PairWall& wall = walls_[number];
      const int movers = int(movable_[wall.a]) + int(movable_[wall.b]);
      const double wanted = relaxation * (margin - slack(wall)) / movers;
      const double step = std::max(wanted, -multipliers_[number]);
      multipliers_[number] += step;
      push(wall, step);
      change = std::max(change, std::fabs(step));
    }
    return change;
  }

  double slack(const PairWall& wall) const { return dot(wall.normal, at_[wall.a] - at_[wall.b]) - wall.least; }

  double shortfall() const {
    double worst = 0;
    for (const PairWall& wall : walls_) worst = std::max(worst, -slack(wall));
    return worst;
  }

  void push(const PairWall& wall, double step) {
    if (movable_[wall.a]) at_[wall.a] = at_[wall.a] + wall.normal * step;
    if (movable_[wall.b]) at_[wall.b] = at_[wall.b] - wall.normal * step;
  }

  const std::vector<PairWall>& walls_;
  const std::vector<bool>& movable_;
  std::vector<Vec3> at_;
  std::vector<double> multipliers_;
  double unit_ = 0, relaxation_ = 1;
};

}  // namespace

LeastMotion least_motion(const std::vector<bool>& movable, const std::vector<PairWall>& walls,
                         std::vector<double> multipliers) {
  return Solver(movable, walls, std::move(multipliers)).solve();
}

}  // namespace satcheck
