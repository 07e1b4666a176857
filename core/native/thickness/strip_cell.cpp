#include "thickness/strip_cell.hpp"

#include <algorithm>
#include <cmath>

#include "base/rounding.hpp"
#include "exact/double_double.hpp"
#include "exact/triangle_distance.hpp"
#include "thickness/cell.hpp"
#include "thickness/nearest_to_zero.hpp"

namespace satcheck {
namespace {

// Measured steps of a piece that is held against a strip, and of a box of heights.
constexpr std::uint64_t kPieceWork = 30, kBoxWork = 200;
// Strips of one region; more are divided.
constexpr std::size_t kMostStrips = 5;
// Boxes of heights that are looked at in a region.
constexpr int kMostHeights = 4000;
// A clipped corner, and what is computed about a region, is off by less than this many roundoffs of the scale.
constexpr double kClippedRoundoffs = 256;
// Planes whose normals are this close to a common plane, or to each other, have no certain intersection.
constexpr double kFlatCorner = 1e-4;
constexpr double kParallel = 0.999;
// Ways against a strip are at least this steep. Normals and ways are off by a few roundoffs, and a way that is as flat as
// that by 1e4 times as many, relative to its length: rounded up.
constexpr double kFlattest = 1e-4;
constexpr double kWaySlack = 1e-11;

DoubleDouble exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

DoubleDouble exact_dot(Vec3 n, Vec3 p) { return exact_product(n.x, p.x) + exact_product(n.y, p.y) + exact_product(n.z, p.z); }

using Shares = std::vector<std::array<double, 3>>;

// Leaves what is below 0, of heights of the three corners.
void cut_off(Shares& polygon, const std::array<double, 3>& heights) {
  Shares cut;
  const auto height = [&](const std::array<double, 3>& p) { return p[0] * heights[0] + p[1] * heights[1] + p[2] * heights[2]; };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto &p = polygon[i], &q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double s = height(p), t = height(q);
    if (s <= 0) cut.push_back(p);
    if ((s < 0 && t > 0) || (s > 0 && t < 0)) {
      const double share = s / (s - t);
      cut.push_back({p[0] + (q[0] - p[0]) * share, p[1] + (q[1] - p[1]) * share, p[2] + (q[2] - p[2]) * share});
    }
  }
  polygon = std::move(cut);
}

struct Strip {
  Vec3 normal;
  DoubleDouble base;
  Range all;
  std::array<Range, 2> of;  // of each body
  Vec3 middle;              // of a piece
  std::vector<const StripPiece*> pieces;

  double height(Vec3 p) const { return static_cast<double>(exact_dot(normal, p) - base); }
};

class Region {
 public:
  Region(const Surface& a, const Surface& b, const StripRegion& region, const std::vector<StripPiece>& pieces, double half, double scale, Budget& budget)
      : surfaces_{&a, &b}, region_(region), pieces_(pieces), budget_(budget), half_(half), enough_(half * (1 - kWaySlack)),
        rounding_(kClippedRoundoffs * kUnitRoundoff * scale) {
    for (int axis = 0; axis < 3; ++axis) middle_ = middle_ + region.axes.row[axis] * ((region.low[static_cast<std::size_t>(axis)] + region.high[static_cast<std::size_t>(axis)]) / 2);
  }

  StripResult judge() {
    if (is_free()) return {StripAnswer::thin};
    if (!find_strips()) return between_parallel_faces();
    if (strips_.empty()) return {deep_or_divide(middle_)};
    if (const auto cut = parallel_cut()) return {deep_between(*parallel_) ? StripAnswer::deeper : StripAnswer::divide, cut};
    if (parallel_) return {deep_between(*parallel_) ? StripAnswer::deeper : StripAnswer::divide};
    if (!find_meeting_point()) return {};
    const StripAnswer sampled = sample_sectors();
    if (sampled != StripAnswer::thin) return {sampled};
    find_ways();
    if (!look_at_boxes()) return {deep_in_strip() ? StripAnswer::deeper : StripAnswer::divide};
    return {StripAnswer::thin, {}, thick_[0] && thick_[1] && !has_sheet()};
  }

 private:
  const Surface& surface(int body) const { return *surfaces_[static_cast<std::size_t>(body)]; }
  bool is_outside(int body, Vec3 p) const {
    const auto winding = winding_number(surface(body), p, &budget_);
    return winding && *winding == 0;
  }
  bool is_inside(int body, Vec3 p) const {
    const auto winding = winding_number(surface(body), p, &budget_);
    return winding && *winding != 0;
  }

  // Largest triangles first: their planes are the most certain.
  bool find_strips() {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Corners c = corners(surface(pieces_[i].body).mesh, pieces_[i].triangle);
      order.emplace_back(-norm_squared(cross(c[1] - c[0], c[2] - c[0])), i);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [_, i] : order) {
      if (!take(pieces_[i]) && !add(pieces_[i])) return false;
    }
    return true;
  }

  Range heights(const Strip& strip, const StripPiece& piece) const {
    const Corners c = corners(surface(piece.body).mesh, piece.triangle);
    const double h[3] = {strip.height(c[0]), strip.height(c[1]), strip.height(c[2])};
    // What rounds by more than a thousandth of `half` lies across the strip.
    const double most = larger(std::fabs(h[0]), larger(std::fabs(h[1]), std::fabs(h[2])));
    if (!(16 * kUnitRoundoff * most <= 1e-3 * half_)) return {-INFINITY, INFINITY};
    Range range;
    for (const auto& share : piece.shares) range.include(share[0] * h[0] + share[1] * h[1] + share[2] * h[2]);
    return {range.low - 16 * kUnitRoundoff * most, range.high + 16 * kUnitRoundoff * most};
  }

  bool take(const StripPiece& piece) {
    for (Strip& strip : strips_) {
      budget_.spend(kPieceWork);
      const Range range = heights(strip, piece);
      Range all = strip.all;
      all.include(range.low);
      all.include(range.high);
      if (!(all.high - all.low <= 4 * half_)) continue;
      strip.all = all;
      strip.of[static_cast<std::size_t>(piece.body)].include(range.low);
      strip.of[static_cast<std::size_t>(piece.body)].include(range.high);
      strip.pieces.push_back(&piece);
      return true;
    }
    return false;
  }

  bool add(const StripPiece& piece) {
    const Corners c = corners(surface(piece.body).mesh, piece.triangle);
    const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
    const double length = norm(normal);
    if (!(length > 0)) return false;
    Strip strip{normal * (1 / length), {}, {}, {}, {}, {&piece}};
    strip.base = exact_dot(strip.normal, c[0]);
    Vec3 sum;
    for (const auto& share : piece.shares) sum = sum + c[0] * share[0] + c[1] * share[1] + c[2] * share[2];
    strip.middle = sum * (1 / static_cast<double>(piece.shares.size()));
    strip.all = heights(strip, piece);
    strip.of[static_cast<std::size_t>(piece.body)] = strip.all;
    strips_.push_back(strip);
    return strips_.size() <= kMostStrips;
  }

  StripResult between_parallel_faces() {
    const auto cut = parallel_cut();
    if (parallel_ && deep_between(*parallel_)) return {StripAnswer::deeper};
    return {StripAnswer::divide, cut};
  }

  // Between two parallel strips, across the axis that is closest to their normals.
  std::optional<StripCut> parallel_cut() {
    std::optional<StripCut> best;
    double widest = 0;
    for (std::size_t i = 0; i < strips_.size(); ++i) {
      for (std::size_t j = i + 1; j < strips_.size(); ++j) {
        if (std::fabs(dot(strips_[i].normal, strips_[j].normal)) < kParallel) continue;
        const double gap = std::fabs(strips_[i].height(strips_[j].middle));
        if (!parallel_ || gap < parallel_gap_) parallel_ = {i, j}, parallel_gap_ = gap;
        for (int axis = 0; axis < 3; ++axis) {
          const Vec3 along = region_.axes.row[axis];
          if (std::fabs(dot(along, strips_[i].normal)) < 0.9) continue;
          const auto k = static_cast<std::size_t>(axis);
          const double size = region_.high[k] - region_.low[k];
          const double at = (dot(along, strips_[i].middle) + dot(along, strips_[j].middle)) / 2;
          if (gap > 1e-3 * size && gap > widest && at > region_.low[k] + 0.1 * size && at < region_.high[k] - 0.1 * size) best = StripCut{axis, at}, widest = gap;
        }
      }
    }
    return best;
  }

  // Whether a point half way between the two strips is deep in both bodies.
  bool deep_between(std::pair<std::size_t, std::size_t> pair) const {
    const Strip &from = strips_[pair.first], &to = strips_[pair.second];
    const double gap = from.height(to.middle);
    if (!(std::fabs(gap) < 256 * half_)) return false;
    const Vec3 middle = to.middle - from.normal * (gap / 2);
    return is_deep(middle) || is_deep(from.middle + from.normal * (gap / 2));
  }

  // Whether a point half way between the faces of both bodies in the only strip is deep.
  bool deep_in_strip() const {
    if (strips_.size() != 1) return false;
    const Strip& strip = strips_[0];
    const Vec3 from = strip.middle - strip.normal * strip.height(strip.middle);
    for (std::size_t body = 0; body < 2; ++body) {
      const double middle = (strip.of[body].low + strip.of[1 - body].high) / 2;
      if (std::isfinite(middle) && is_deep(from + strip.normal * middle)) return true;
    }
    return false;
  }

  bool is_deep(Vec3 p) const { return is_deep_in(0, p) && is_deep_in(1, p); }

  bool is_deep_in(int body, Vec3 p) const {
    if (!is_inside(body, p)) return false;
    const double least = half_ * (1 + kWaySlack), near = least + rounding_;
    const Surface& of = surface(body);
    bool deep = true;
    const Vec3 wide = Vec3{1, 1, 1} * (near + rounding_);
    visit_box(of.bvh, of.mesh, {p - wide, p + wide}, [&](std::uint32_t t) {
      const Corners c = corners(of.mesh, t);
      if (norm(nearest_on_triangle(p, c) - p) > near) return true;
      const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
      const double length = norm(normal);
      Range range;
      if (length > 0) {
        const Vec3 unit = normal * (1 / length);
        const DoubleDouble at = exact_dot(unit, p);
        for (const Vec3 corner : c) range.include(static_cast<double>(exact_dot(unit, corner) - at));
      }
      deep = length > 0 && (range.low > least || range.high < -least);
      return deep;
    }, &budget_);
    return deep;
  }

  // Whether one body has no point in the region.
  bool is_free() const {
    for (int body = 0; body < 2; ++body) {
      const auto is_of_body = [&](const StripPiece& piece) { return piece.body == body; };
      if (std::none_of(pieces_.begin(), pieces_.end(), is_of_body) && is_outside(body, middle_)) return true;
    }
    return false;
  }

  // Whether a piece, beyond all other strips, has nothing of its body on either side of its strip.
  bool has_sheet() const {
    const std::uint32_t count = 1u << strips_.size();
    for (std::size_t i = 0; i < strips_.size(); ++i) {
      for (const StripPiece* piece : strips_[i].pieces) {
        const auto& outside = outside_[static_cast<std::size_t>(piece->body)];
        for (std::uint32_t sector = 0; sector < count; ++sector) {
          if (sector >> i & 1 || !outside[sector] || !outside[sector | 1u << i]) continue;
          if (reaches_into(*piece, i, sector)) return true;
        }
      }
    }
    return false;
  }

  // Whether the piece, in strip i, has a point on the sides of all others that the sector is on.
  bool reaches_into(const StripPiece& piece, std::size_t i, std::uint32_t sector) const {
    const Corners c = corners(surface(piece.body).mesh, piece.triangle);
    Shares left = piece.shares;
    std::vector<std::array<double, 3>> walls;
    for (std::size_t k = 0; k < strips_.size() && !left.empty(); ++k) {
      if (k == i) continue;
      const Strip& strip = strips_[k];
      const double sign = sector >> k & 1 ? -1.0 : 1.0, wall = sign > 0 ? strip.all.low : -strip.all.high;
      const std::array<double, 3> heights{sign * strip.height(c[0]) - wall, sign * strip.height(c[1]) - wall, sign * strip.height(c[2]) - wall};
      cut_off(left, heights);
      walls.push_back(heights);
    }
    // Not only on the planes of the strips: what is left has its mean strictly beyond them.
    std::array<double, 3> mean{};
    for (const auto& p : left) {
      for (std::size_t k = 0; k < 3; ++k) mean[k] += p[k] / static_cast<double>(left.size());
    }
    const auto is_beyond = [&](const std::array<double, 3>& h) { return mean[0] * h[0] + mean[1] * h[1] + mean[2] * h[2] < 0; };
    return !left.empty() && std::all_of(walls.begin(), walls.end(), is_beyond);
  }

  StripAnswer deep_or_divide(Vec3 p) const { return is_deep(p) ? StripAnswer::deeper : StripAnswer::divide; }

  double least_room(Vec3 p) const {
    double room = INFINITY;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = dot(region_.axes.row[k], p);
      room = smaller(room, smaller(at - region_.low[k], region_.high[k] - at));
    }
    return room;
  }

  // A point that all strips have in common, with those made wider where they just miss it.
  bool find_meeting_point() {
    Vec3 from;
    for (const Strip& strip : strips_) from = from + strip.middle * (1 / static_cast<double>(strips_.size()));
    std::vector<Vec3> basis;
    meeting_ = from;
    for (const Strip& strip : strips_) {
      Vec3 rest = strip.normal;
      for (const Vec3 e : basis) rest = rest - e * dot(e, rest);
      const double length = norm(rest);
      if (length < kFlatCorner) continue;
      const Vec3 e = rest * (1 / length);
      basis.push_back(e);
      const double middle = (strip.all.low + strip.all.high) / 2;
      meeting_ = meeting_ + e * ((middle - strip.height(meeting_)) / length);
    }
    if (!(least_room(meeting_) > rounding_ + 2 * half_)) return false;
    width_ = half_ / 16;
    for (Strip& strip : strips_) {
      strip.all.include(strip.height(meeting_));
      width_ = larger(width_, strip.all.high - strip.all.low);
    }
    return width_ <= 16 * half_;
  }

  std::vector<Vec3> signed_normals(std::uint32_t which, std::uint32_t signs) const {
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < strips_.size(); ++i) {
      if (which >> i & 1) result.push_back(signs >> i & 1 ? strips_[i].normal : -strips_[i].normal);
    }
    return result;
  }

  std::uint32_t every_strip() const { return (1u << strips_.size()) - 1; }

  // Bit i of a sector: above strip i.
  StripAnswer sample_sectors() {
    const std::uint32_t count = 1u << strips_.size();
    for (int body = 0; body < 2; ++body) {
      outside_[static_cast<std::size_t>(body)].assign(count, false);
      for (std::size_t i = 0; i < strips_.size(); ++i) {
        if (!strips_[i].of[static_cast<std::size_t>(body)].empty()) own_[static_cast<std::size_t>(body)] |= 1u << i;
      }
    }
    empty_.assign(count, false);
    double diagonal = 0;
    for (std::size_t k = 0; k < 3; ++k) diagonal += region_.high[k] - region_.low[k];
    std::vector<Vec3> ways(count);
    double wider = 0;
    for (std::uint32_t sector = 0; sector < count; ++sector) {
      ways[sector] = nearest_to_zero(signed_normals(every_strip(), sector));
      empty_[sector] = norm(ways[sector]) < kFlatCorner;
      if (empty_[sector]) wider = larger(wider, (norm(ways[sector]) + 16 * kUnitRoundoff) * diagonal);
    }
    // The sector of normals that cancel would need points farther from the strips than the region is large.
    if (wider > 4 * half_) return StripAnswer::divide;
    for (Strip& strip : strips_) strip.all = {strip.all.low - wider, strip.all.high + wider};
    std::vector<Vec3> samples(count);
    for (std::uint32_t sector = 0; sector < count; ++sector) {
      if (empty_[sector]) continue;
      const auto sample = sample_of(sector, ways[sector]);
      if (!sample) return StripAnswer::divide;
      bool in_both = true;
      for (int body = 0; body < 2; ++body) {
        if (!is_outside(body, *sample)) {
          thick_[static_cast<std::size_t>(body)] = true;
          continue;
        }
        in_both = false;
        const std::uint32_t own = own_[static_cast<std::size_t>(body)];
        for (std::uint32_t other = 0; other < count; ++other) {
          if ((other & own) == (sector & own)) outside_[static_cast<std::size_t>(body)][other] = true;
        }
      }
      if (in_both) return deep_or_divide(*sample);
    }
    return StripAnswer::thin;
  }

  std::optional<Vec3> sample_of(std::uint32_t sector, Vec3 way) const {
    const Vec3 unit = way * (1 / norm(way));
    double room = INFINITY;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = dot(region_.axes.row[k], meeting_), slope = dot(region_.axes.row[k], unit);
      if (slope > 1e-12) room = smaller(room, (region_.high[k] - at) / slope);
      if (slope < -1e-12) room = smaller(room, (region_.low[k] - at) / slope);
    }
    const Vec3 p = meeting_ + unit * (room / 2);
    if (!(least_room(p) > rounding_)) return std::nullopt;
    for (std::size_t i = 0; i < strips_.size(); ++i) {
      const double h = strips_[i].height(p);
      if (sector >> i & 1 ? !(h > strips_[i].all.high) : !(h < strips_[i].all.low)) return std::nullopt;
    }
    return p;
  }

  // Directions away from strips.
  void find_ways() {
    for (std::uint32_t which = 1; which <= every_strip(); ++which) {
      for (std::uint32_t signs = which;; signs = (signs - 1) & which) {
        const Vec3 way = nearest_to_zero(signed_normals(which, signs));
        const double length = norm(way);
        if (length >= kFlatCorner) {
          std::array<double, kMostStrips> slopes{};
          for (std::size_t i = 0; i < strips_.size(); ++i) slopes[i] = dot(strips_[i].normal, way) / length;
          ways_.push_back(slopes);
        }
        if (signs == 0) break;
      }
    }
  }

  using Heights = std::array<Range, kMostStrips>;

  bool look_at_boxes() {
    boxes_left_ = kMostHeights;
    Heights box;
    return look_at_layers(box, 0);
  }

  // All of the height above each strip: layers beyond it, and the strip.
  bool look_at_layers(Heights& box, std::size_t i) {
    if (i == strips_.size()) return look_at(box);
    const Range all = strips_[i].all;
    const double far = 8 * width_, near = width_;
    const double ends[] = {-INFINITY, all.low - far, all.low - near, all.low, all.high, all.high + near, all.high + far, INFINITY};
    for (std::size_t k = 0; k + 1 < std::size(ends); ++k) {
      box[i] = {ends[k], ends[k + 1]};
      if (!look_at_layers(box, i + 1)) return false;
    }
    return true;
  }

  bool look_at(const Heights& box) {
    if (--boxes_left_ < 0) return false;
    budget_.spend(kBoxWork);
    if (has_no_point(box) || is_shallow(0, box) || is_shallow(1, box)) return true;
    std::size_t widest = strips_.size();
    double size = half_ / 512;
    for (std::size_t i = 0; i < strips_.size(); ++i) {
      const double here = box[i].high - box[i].low;
      if (here < INFINITY && here > size) widest = i, size = here;
    }
    if (widest == strips_.size()) return false;
    Heights low = box, high = box;
    low[widest].high = high[widest].low = (box[widest].low + box[widest].high) / 2;
    return look_at(low) && look_at(high);
  }

  // Whether nothing that is in both bodies has such heights.
  bool has_no_point(const Heights& box) const {
    std::uint32_t above = 0, clear = 0;
    for (std::size_t i = 0; i < strips_.size(); ++i) {
      if (box[i].low >= strips_[i].all.high) above |= 1u << i, clear |= 1u << i;
      if (box[i].high <= strips_[i].all.low) clear |= 1u << i;
    }
    if (clear == every_strip() && empty_[above]) return true;
    for (std::size_t body = 0; body < 2; ++body) {
      std::uint32_t own_above = 0, own_clear = 0;
      for (std::size_t i = 0; i < strips_.size(); ++i) {
        const Range& own = strips_[i].of[body];
        if (own.empty()) continue;
        if (box[i].low >= own.high) own_above |= 1u << i, own_clear |= 1u << i;
        else if (box[i].high <= own.low) own_clear |= 1u << i;
      }
      if (own_clear == own_[body] && has_outside(body, own_above)) return true;
    }
    return false;
  }

  bool has_outside(std::size_t body, std::uint32_t sector) const {
    for (std::uint32_t other = 0; other < outside_[body].size(); ++other) {
      if ((other & own_[body]) == (sector & own_[body]) && outside_[body][other]) return true;
    }
    return false;
  }

  // Whether a way no longer than enough leads from all such points to a sector outside of the body.
  bool is_shallow(std::size_t body, const Heights& box) const {
    for (std::uint32_t sector = 0; sector < outside_[body].size(); ++sector) {
      if (!outside_[body][sector] || (sector & ~own_[body]) != 0) continue;
      for (const auto& slopes : ways_) {
        if (leads_out(body, box, sector, slopes)) return true;
      }
    }
    return false;
  }

  bool leads_out(std::size_t body, const Heights& box, std::uint32_t sector, const std::array<double, kMostStrips>& slopes) const {
    double least = 0, most = enough_;
    for (std::size_t i = 0; i < strips_.size(); ++i) {
      if (!(own_[body] >> i & 1)) continue;
      const bool up = sector >> i & 1;
      const Range& own = strips_[i].of[body];
      const double left = up ? own.high - box[i].low : box[i].high - own.low;
      const double slope = up ? slopes[i] : -slopes[i];
      if (left > 0) {
        if (!(slope > kFlattest)) return false;
        least = larger(least, left / slope);
      } else if (slope < 0) {
        most = smaller(most, left / slope);
      }
      if (least > most) return false;
    }
    return true;
  }

  std::array<const Surface*, 2> surfaces_;
  const StripRegion& region_;
  const std::vector<StripPiece>& pieces_;
  Budget& budget_;
  double half_, enough_, rounding_;
  Vec3 middle_, meeting_;
  std::vector<Strip> strips_;
  std::optional<std::pair<std::size_t, std::size_t>> parallel_;
  double parallel_gap_ = 0, width_ = 0;
  std::array<std::vector<bool>, 2> outside_;      // by body and sector: proven
  std::array<std::uint32_t, 2> own_{};            // strips with a piece of the body
  std::array<bool, 2> thick_{};                   // by body: whether a sector is not outside
  std::vector<bool> empty_;                       // by sector: proven
  std::vector<std::array<double, kMostStrips>> ways_;  // slopes against the strips
  int boxes_left_ = 0;
};

}  // namespace

StripPiece clipped(const Surface& surface, int body, std::uint32_t triangle, const StripRegion& region, double scale) {
  StripPiece piece{body, triangle, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Corners c = corners(surface.mesh, triangle);
  const double wide = kClippedRoundoffs * kUnitRoundoff * scale;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 axis = region.axes.row[k];
    for (const double sign : {1.0, -1.0}) {
      const double wall = (sign > 0 ? region.high[k] : -region.low[k]) + wide;
      cut_off(piece.shares, {sign * dot(axis, c[0]) - wall, sign * dot(axis, c[1]) - wall, sign * dot(axis, c[2]) - wall});
    }
  }
  return piece;
}

StripResult judge_strips(const Surface& a, const Surface& b, const StripRegion& region, const std::vector<StripPiece>& pieces,
                         double half, double scale, Budget& budget) {
  return Region(a, b, region, pieces, half, scale, budget).judge();
}

}  // namespace satcheck
