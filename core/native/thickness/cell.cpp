#include "thickness/cell.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/rounding.hpp"

namespace satcheck {
namespace {

// What a height minus a dot product is off by, as a share of the scale: 3 products and 3 sums, each at most 2
// times the scale, and once more for the rounding of the point itself; rounded up.
constexpr double kResidualError = 16 * kUnitRoundoff;
// Where three planes with a smaller determinant meet is not known.
constexpr double kLeastDeterminant = 2e-13;
// Heights are tried in steps of this many times the distance that is too close, on both sides.
constexpr double kStep = 3;
constexpr int kTries = 7;
constexpr std::size_t kMostSides = 60;

struct Place {
  Vec3 at;
  double error = INFINITY;
};

// Where three planes meet: a guess corrected by its residuals, of which the error follows.
Place meeting_point(const HalfSpace& a, const HalfSpace& b, const HalfSpace& c, Vec3 guess, double scale) {
  const Vec3 bc = cross(b.normal, c.normal), ca = cross(c.normal, a.normal), ab = cross(a.normal, b.normal);
  const double det = dot(a.normal, bc);
  if (!(std::fabs(det) > kLeastDeterminant)) return {guess};
  for (int i = 0; i < 2; ++i) {
    const auto residual = [&](const HalfSpace& plane) { return plane.height - dot(plane.normal, guess); };
    guess = guess + (bc * residual(a) + ca * residual(b) + ab * residual(c)) * (1 / det);
  }
  return {guess, 2 * kResidualError * scale * (norm(bc) + norm(ca) + norm(ab)) / std::fabs(det)};
}

Place meeting_point(const std::vector<HalfSpace>& sides, std::uint64_t planes, Vec3 guess, double scale) {
  const int a = std::countr_zero(planes), b = std::countr_zero(planes & (planes - 1));
  const int c = std::countr_zero(planes & ~(std::uint64_t{1} << a) & ~(std::uint64_t{1} << b));
  const auto side = [&](int i) -> const HalfSpace& { return sides[static_cast<std::size_t>(i)]; };
  return meeting_point(side(a), side(b), side(c), guess, scale);
}

// Sides without a corner are left out.
void drop_unused_sides(Cell& cell) {
  std::uint64_t used = 0;
  for (const Cell::Corner& corner : cell.corners) used |= corner.planes;
  if (used + 1 == std::uint64_t{1} << cell.sides.size()) return;
  std::vector<HalfSpace> sides;
  std::vector<std::uint64_t> bits(cell.sides.size(), 0);
  for (std::size_t i = 0; i < cell.sides.size(); ++i) {
    if (!(used >> i & 1)) continue;
    bits[i] = std::uint64_t{1} << sides.size();
    sides.push_back(cell.sides[i]);
  }
  for (Cell::Corner& corner : cell.corners) {
    std::uint64_t planes = 0;
    for (std::uint64_t rest = corner.planes; rest != 0; rest &= rest - 1) {
      planes |= bits[static_cast<std::size_t>(std::countr_zero(rest))];
    }
    corner.planes = planes;
  }
  cell.sides = std::move(sides);
}

// Of each corner, the signed distance from the plane.
std::vector<double> heights(const Cell& cell, const HalfSpace& plane) {
  std::vector<double> result;
  result.reserve(cell.corners.size());
  for (const Cell::Corner& corner : cell.corners) result.push_back(dot(plane.normal, corner.at) - plane.height);
  return result;
}

// An edge of a cell through a plane.
struct Crossing {
  std::size_t below, above;  // corners
  Cell::Corner corner;
  double error;
};

std::vector<Crossing> crossings(const Cell& cell, const HalfSpace& plane, const std::vector<double>& beyond, double scale) {
  std::vector<HalfSpace> sides = cell.sides;
  sides.push_back(plane);
  const std::uint64_t bit = std::uint64_t{1} << cell.sides.size();
  std::vector<Crossing> result;
  for (std::size_t i = 0; i < cell.corners.size(); ++i) {
    const Cell::Corner& below = cell.corners[i];
    for (std::size_t k = 0; k < cell.corners.size() && beyond[i] <= 0; ++k) {
      const Cell::Corner& above = cell.corners[k];
      const std::uint64_t common = below.planes & above.planes;
      if (beyond[k] <= 0 || std::popcount(common) < 2) continue;
      const Vec3 guess = below.at + (above.at - below.at) * (beyond[i] / (beyond[i] - beyond[k]));
      const Place place = meeting_point(sides, common | bit, guess, scale);
      result.push_back({i, k, {place.at, common | bit}, place.error});
    }
  }
  return result;
}

// The part where sign * (normal . p - height) <= 0.
Cell part(const Cell& cell, const HalfSpace& plane, const std::vector<double>& beyond,
          const std::vector<Crossing>& crossings, double sign) {
  Cell result{cell.sides, {}, cell.error};
  result.sides.push_back({plane.normal * sign, plane.height * sign});
  for (std::size_t i = 0; i < cell.corners.size(); ++i) {
    if (beyond[i] * sign <= 0) result.corners.push_back(cell.corners[i]);
  }
  for (const Crossing& crossing : crossings) {
    result.error = larger(result.error, crossing.error);
    result.corners.push_back(crossing.corner);
  }
  drop_unused_sides(result);
  return result;
}

}  // namespace

Range Cell::along(Vec3 direction) const {
  Range range;
  for (const Corner& corner : corners) range.include(dot(direction, corner.at));
  return range;
}

Aabb Cell::box() const {
  Aabb result;
  for (const Corner& corner : corners) result.include(corner.at);
  return result.widened(error);
}

Cell make_cell(const Mat3& axes, Vec3 low, Vec3 high, int flat, double scale) {
  Cell cell;
  if (flat >= 0) cell.sides.push_back({axes.row[flat], high[flat]});
  std::uint64_t bits[3][2];
  for (int axis = 0; axis < 3; ++axis) {
    for (int up = 0; up < 2; ++up) {
      bits[axis][up] = axis == flat ? 1 : std::uint64_t{1} << cell.sides.size();
      if (axis == flat) continue;
      cell.sides.push_back(up ? HalfSpace{axes.row[axis], high[axis]} : HalfSpace{-axes.row[axis], -low[axis]});
    }
  }
  for (int k = 0; k < 8; ++k) {
    if (flat >= 0 && k >> flat & 1) continue;
    const Vec3 at{k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z};
    const std::uint64_t planes = bits[0][k & 1] | bits[1][k >> 1 & 1] | bits[2][k >> 2 & 1];
    const Place place = meeting_point(cell.sides, planes, transpose_times(axes, at), scale);
    cell.corners.push_back({place.at, planes});
    cell.error = larger(cell.error, place.error);
  }
  return cell;
}

std::optional<Halves> split(const Cell& cell, const HalfSpace& plane, double scale, double error) {
  if (cell.sides.size() >= kMostSides) return std::nullopt;
  const double close = cell.error + kResidualError * scale;
  double shift = 0;
  for (int i = 1; i <= kTries; ++i) {
    const HalfSpace tried{plane.normal, plane.height + shift};
    const std::vector<double> beyond = heights(cell, tried);
    bool clear = true, below = false, above = false;
    for (const double height : beyond) {
      clear = clear && std::fabs(height) > close;
      below = below || height < 0;
      above = above || height > 0;
    }
    if (!clear) {
      shift = kStep * close * ((i + 1) / 2) * (i % 2 == 0 ? 1 : -1);
      continue;
    }
    if (!below || !above) return std::nullopt;
    const std::vector<Crossing> cut = crossings(cell, tried, beyond, scale);
    const auto worst = std::max_element(cut.begin(), cut.end(), [](const auto& p, const auto& q) { return p.error < q.error; });
    if (worst->error <= error) return Halves{part(cell, tried, beyond, cut, 1), part(cell, tried, beyond, cut, -1), tried};
    // An edge that is almost in the plane: past its nearer end.
    const double down = beyond[worst->below], up = beyond[worst->above];
    shift += up < -down ? up + kStep * close : down - kStep * close;
  }
  return std::nullopt;
}

}  // namespace satcheck
