#include "mesh/flat_cells.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "exact/predicates.hpp"
#include "exact/ratio.hpp"
#include "mesh/bvh.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

// The rounding error of a ratio or a sum of two products, in addition to the error of the inputs.
constexpr double kRoundingError = 8 * std::numeric_limits<double>::epsilon();

// Below this a rounded fraction may have lost digits.
constexpr double kSmallestFraction = 1e-200;

Aabb segment_box(const PlaneSegment& s) {
  Aabb box = point_box(s.p);
  box.include(point_box(s.q));
  return box;
}

class Pieces {
 public:
  Pieces(const std::array<Vec3, 3>& triangle, const std::vector<PlaneSegment>& cuts, Touching touching,
         Budget* budget)
      : budget_(budget),
        axis_(projection_axis(rounded_normal(triangle[0], triangle[1], triangle[2]))),
        turn_(orientation_2d(triangle[0], triangle[1], triangle[2], axis_)),
        corners_{make_exact_point(triangle[0]), make_exact_point(triangle[1]), make_exact_point(triangle[2])} {
    for (int k = 0; k < 3; ++k) segments_.push_back({corners_[k], corners_[(k + 1) % 3]});
    for (const PlaneSegment& cut : cuts) {
      if (reaches(cut, touching)) segments_.push_back(cut);
    }
    Mesh boxes;
    for (const PlaneSegment& s : segments_) {
      const Aabb box = segment_box(s);
      const auto first = static_cast<std::uint32_t>(boxes.vertices.size());
      boxes.vertices.push_back(box.min);
      boxes.vertices.push_back(box.max);
      boxes.triangles.push_back({first, first + 1, first + 1});
    }
    tree_ = build_bvh(boxes, 1);
  }

  bool visit(const std::function<bool(const Piece&)>& visitor) const {
    if (segments_.size() == 3) return visitor(whole());
    for (const PlaneSegment& s : segments_) {
      const std::vector<Ratio> stops = find_stops(s);
      for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
        if (!less(stops[k], stops[k + 1])) continue;
        if (!visit_sides(s, stops[k], stops[k + 1], visitor)) return false;
      }
    }
    return true;
  }

 private:
  // The samples lie on a parabola through a corner: no three on a line.
  Piece whole() const {
    return {[this](int k) {
              const Dyadic n = 1.0 + k;
              return between(between(corners_[0], corners_[1], n, n * n), corners_[2], n + n * n, 1.0);
            },
            [this] { return std::vector<ExactPoint>(corners_.begin(), corners_.end()); }};
  }

  int side(const PlaneSegment& s, const ExactPoint& p) const {
    return orientation_2d_at(s.p, s.q, p, axis_);
  }

  // False: the segment is completely beyond the line of a triangle edge, or on it.
  bool reaches(const PlaneSegment& s, Touching touching) const {
    const int least = touching == Touching::kept ? 0 : 1;
    for (int k = 0; k < 3; ++k) {
      if (turn_ * side(segments_[k], s.p) < least && turn_ * side(segments_[k], s.q) < least) return false;
    }
    return true;
  }

  // The place where the line o meets the segment from `from` to `to`. Its ends are on different sides of o.
  Ratio meeting(const PlaneSegment& o, const ExactPoint& from, const ExactPoint& to) const {
    spend(budget_, sign_work(o.p) + sign_work(o.q));
    const Dyadic near = area_value(o.p, o.q, from, axis_) * to.w;
    const Dyadic far = area_value(o.p, o.q, to, axis_) * from.w;
    return zero_between(near, far);
  }

  // The position of v on the segment from `from` to `to`. v lies on its line.
  Ratio position(const ExactPoint& from, const ExactPoint& to, const ExactPoint& v) const {
    const auto step = [&](const ExactPoint& p, int axis) {
      return coordinate(p, axis) * from.w - coordinate(from, axis) * p.w;
    };
    const auto [i, j] = plane_axes(axis_);
    const int k = step(to, i).sign() != 0 ? i : j;
    return make_ratio(step(v, k) * to.w, step(to, k) * v.w);
  }

  template <class Visit>
  void visit_near(const Aabb& box, Visit visit) const {
    visit_box(tree_, box, [&](std::uint32_t k) {
      visit(segments_[k]);
      return true;
    });
  }

  // The places where other segments meet s, and its ends, in order.
  std::vector<Ratio> find_stops(const PlaneSegment& s) const {
    const Ratio start{0.0, 1.0}, end{1.0, 1.0};
    std::vector<Ratio> stops{start, end};
    visit_near(segment_box(s), [&](const PlaneSegment& o) {
      const int p_side = side(o, s.p), q_side = side(o, s.q);
      if (p_side * q_side > 0) return;
      if (p_side == 0 && q_side == 0) {
        for (const ExactPoint* v : {&o.p, &o.q}) {
          Ratio at = position(s.p, s.q, *v);
          if (less(start, at) && less(at, end)) stops.push_back(std::move(at));
        }
        return;
      }
      if (p_side == 0 || q_side == 0) return;  // at an end of s
      if (side(s, o.p) * side(s, o.q) > 0) return;
      stops.push_back(meeting(o, s.p, s.q));
    });
    std::sort(stops.begin(), stops.end(), less);
    return stops;
  }

  ExactPoint at(const PlaneSegment& s, const Ratio& r) const {
    return between(s.p, s.q, r.denominator - r.numerator, r.numerator);
  }

  // The middle of a stretch, or a point of it near the middle that has fewer digits.
  ExactPoint middle(const PlaneSegment& s, const Ratio& from, const Ratio& to) const {
    spend(budget_, sign_work(s.p));
    const Ratio near{0.5 * (rounded(from) + rounded(to)), 1.0};
    if (less(from, near) && less(near, to)) return at(s, near);
    return at(s, {from.numerator * to.denominator + to.numerator * from.denominator,
                  from.denominator * to.denominator * 2.0});
  }

  bool strictly_outside(const ExactPoint& m) const {
    for (int k = 0; k < 3; ++k) {
      if (turn_ * side(segments_[k], m) < 0) return true;
    }
    return false;
  }

  bool visit_sides(const PlaneSegment& s, const Ratio& from, const Ratio& to,
                   const std::function<bool(const Piece&)>& visitor) const {
    const ExactPoint m = middle(s, from, to);
    if (strictly_outside(m)) return true;
    const double length = norm(s.q.rounded - s.p.rounded) * (rounded(to) - rounded(from));
    for (const int way : {1, -1}) {
      // A corner on this side of s: the way there stays in the triangle.
      const auto target = std::find_if(corners_.begin(), corners_.end(),
                                       [&](const ExactPoint& v) { return side(s, v) == way; });
      if (target == corners_.end()) continue;
      const Ratio clear = clear_way(m, *target, length);
      const Piece piece{[&](int attempt) { return part_of_way(m, *target, clear, attempt); },
                        [&] { return std::vector<ExactPoint>{at(s, from), at(s, to)}; }};
      if (!visitor(piece)) return false;
    }
    return true;
  }

  ExactPoint part_of_way(const ExactPoint& m, const ExactPoint& v, const Ratio& clear, int attempt) const {
    const double parts = attempt + 2.0, fraction = rounded(clear) / parts;
    if (fraction > kSmallestFraction) return between(m, v, Dyadic(1.0) - fraction, fraction);
    return between(m, v, clear.denominator * parts - clear.numerator, clear.numerator);
  }

  // The clear part of the segment from m to v, up to the first segment that it meets. It is not much longer than
  // `length`, so that few segments are near.
  Ratio clear_way(const ExactPoint& m, const ExactPoint& v, double length) const {
    const double whole = norm(v.rounded - m.rounded);
    const double limit = length > 0 && length < whole ? length / whole : 1.0;
    Ratio nearest{limit, 1.0};
    const auto consider = [&](Ratio at) {
      if (at.numerator.sign() > 0 && less(at, nearest)) nearest = std::move(at);
    };
    visit_near(way_box(m, v, limit), [&](const PlaneSegment& o) {
      const int m_side = side(o, m), v_side = side(o, v);
      if (m_side == 0 && v_side == 0) {
        consider(position(m, v, o.p));
        consider(position(m, v, o.q));
      } else if (m_side * v_side < 0) {
        const int p_side = orientation_2d_at(m, v, o.p, axis_), q_side = orientation_2d_at(m, v, o.q, axis_);
        if (p_side * q_side <= 0) consider(meeting(o, m, v));
      }
    });
    return nearest;
  }

  Aabb way_box(const ExactPoint& m, const ExactPoint& v, double limit) const {
    Aabb box = point_box(m);
    const Vec3 end = m.rounded * (1 - limit) + v.rounded * limit;
    const auto error = [&](int k) {
      return m.error[k] + kRoundingError * (std::fabs(m.rounded[k]) + std::fabs(v.rounded[k]));
    };
    const Vec3 slack{error(0), error(1), error(2)};
    box.include(Aabb{end - slack, end + slack});
    return box;
  }

  Budget* budget_;
  int axis_;
  int turn_;
  std::array<ExactPoint, 3> corners_;
  std::vector<PlaneSegment> segments_;  // the triangle's edges, then the cuts
  Bvh tree_;
};

}  // namespace

bool visit_pieces(const std::array<Vec3, 3>& triangle, const std::vector<PlaneSegment>& cuts,
                  Touching touching, const std::function<bool(const Piece&)>& visit, Budget* budget) {
  return Pieces(triangle, cuts, touching, budget).visit(visit);
}

}  // namespace satcheck
