#include "flat_cells.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "predicates.hpp"
#include "winding.hpp"

namespace satcheck {
namespace {

// rounded_ratio() is within 2 ulp, and the margin itself is rounded.
constexpr double kRatioError = 4 * std::numeric_limits<double>::epsilon();

// numerator / denominator, denominator > 0.
struct Ratio {
  Dyadic numerator, denominator;
};

bool less(const Ratio& a, const Ratio& b) {
  return (a.numerator * b.denominator - b.numerator * a.denominator).sign() < 0;
}

Ratio make_ratio(Dyadic numerator, Dyadic denominator) {
  if (denominator.sign() < 0) return {-numerator, -denominator};
  return {std::move(numerator), std::move(denominator)};
}

// A projected point (x, y) / w, w > 0.
struct PlanePoint {
  Dyadic x, y, w;
};

class Pieces {
 public:
  Pieces(const std::array<Vec3, 3>& triangle, const std::vector<PlaneSegment>& cuts)
      : triangle_(triangle),
        axis_(projection_axis(rounded_normal(triangle[0], triangle[1], triangle[2]))),
        i_(axis_ == 2 ? 0 : axis_ + 1),
        j_(axis_ == 0 ? 2 : axis_ - 1),
        turn_(orientation_2d(triangle[0], triangle[1], triangle[2], axis_)) {
    for (int k = 0; k < 3; ++k) segments_.push_back({triangle[k], triangle[(k + 1) % 3]});
    for (const PlaneSegment& cut : cuts) {
      if (reaches_interior(cut)) segments_.push_back(cut);
    }
  }

  bool visit(const std::function<bool(const PieceSampler&)>& visitor) const {
    if (segments_.size() == 3) {
      return visitor([this](int attempt) {
        return weighted_point(triangle_[0], triangle_[1], triangle_[2], 1.0 + attempt, 1, 1);
      });
    }
    for (const PlaneSegment& s : segments_) {
      const std::vector<Ratio> stops = find_stops(s);
      for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
        if (!less(stops[k], stops[k + 1])) continue;
        if (!visit_sides(s, middle(s, stops[k], stops[k + 1]), visitor)) return false;
      }
    }
    return true;
  }

 private:
  // False for segments that stay on or beyond the line of one triangle edge.
  bool reaches_interior(const PlaneSegment& s) const {
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = triangle_[k], v = triangle_[(k + 1) % 3];
      if (turn_ * orientation_2d(u, v, s.p, axis_) <= 0 &&
          turn_ * orientation_2d(u, v, s.q, axis_) <= 0) {
        return false;
      }
    }
    return true;
  }

  // (v - u) x (p - u) of float64 points, exactly.
  Dyadic area(Vec3 u, Vec3 v, Vec3 p) const {
    const Dyadic ui = u[i_], uj = u[j_];
    return (v[i_] - ui) * (p[j_] - uj) - (v[j_] - uj) * (p[i_] - ui);
  }
  // The same times p.w.
  Dyadic area(Vec3 u, Vec3 v, const PlanePoint& p) const {
    const Dyadic ui = u[i_], uj = u[j_];
    return (v[i_] - ui) * (p.y - uj * p.w) - (v[j_] - uj) * (p.x - ui * p.w);
  }

  // Position of v along s, which it is collinear with.
  Ratio position(const PlaneSegment& s, Vec3 v) const {
    const int k = s.p[i_] != s.q[i_] ? i_ : j_;
    return make_ratio(Dyadic(v[k]) - s.p[k], Dyadic(s.q[k]) - s.p[k]);
  }

  // Where other segments meet s, and its ends, in order.
  std::vector<Ratio> find_stops(const PlaneSegment& s) const {
    const Ratio start{0.0, 1.0}, end{1.0, 1.0};
    std::vector<Ratio> stops{start, end};
    for (const PlaneSegment& o : segments_) {
      const int p_side = orientation_2d(o.p, o.q, s.p, axis_);
      const int q_side = orientation_2d(o.p, o.q, s.q, axis_);
      if (p_side * q_side > 0) continue;
      if (p_side == 0 && q_side == 0) {
        for (const Vec3 v : {o.p, o.q}) {
          const Ratio at = position(s, v);
          if (less(start, at) && less(at, end)) stops.push_back(at);
        }
        continue;
      }
      if (p_side == 0 || q_side == 0) continue;  // at an end of s
      if (orientation_2d(s.p, s.q, o.p, axis_) * orientation_2d(s.p, s.q, o.q, axis_) > 0) continue;
      const Dyadic p_area = area(o.p, o.q, s.p), q_area = area(o.p, o.q, s.q);
      stops.push_back(make_ratio(p_area, p_area - q_area));
    }
    std::sort(stops.begin(), stops.end(), less);
    return stops;
  }

  PlanePoint middle(const PlaneSegment& s, const Ratio& from, const Ratio& to) const {
    // (from + to) / 2 = numerator / denominator
    const Dyadic numerator = from.numerator * to.denominator + to.numerator * from.denominator;
    const Dyadic denominator = from.denominator * to.denominator * 2.0;
    const auto along = [&](double p, double q) {
      return Dyadic(p) * denominator + (Dyadic(q) - p) * numerator;
    };
    return {along(s.p[i_], s.q[i_]), along(s.p[j_], s.q[j_]), denominator};
  }

  bool strictly_outside(const PlanePoint& m) const {
    for (int k = 0; k < 3; ++k) {
      if (turn_ * area(triangle_[k], triangle_[(k + 1) % 3], m).sign() < 0) return true;
    }
    return false;
  }

  bool visit_sides(const PlaneSegment& s, const PlanePoint& m,
                   const std::function<bool(const PieceSampler&)>& visitor) const {
    if (strictly_outside(m)) return true;
    for (const int side : {1, -1}) {
      // A corner on this side of s: the way there stays in the triangle.
      const auto target = std::find_if(triangle_.begin(), triangle_.end(), [&](Vec3 v) {
        return orientation_2d(s.p, s.q, v, axis_) == side;
      });
      if (target == triangle_.end()) continue;
      const Ratio clear = clear_way(m, *target);
      const bool goes_on = visitor([&](int attempt) {
        return lift(along_ray(m, *target, clear, 1.0 / (1 << (attempt + 1))));
      });
      if (!goes_on) return false;
    }
    return true;
  }

  // How far the way from m to v is clear: up to v or to the first segment that is met.
  Ratio clear_way(const PlanePoint& m, Vec3 v) const {
    Ratio nearest{1.0, 1.0};
    const auto consider = [&](Ratio at) {
      if (at.numerator.sign() > 0 && less(at, nearest)) nearest = std::move(at);
    };
    const Aabb way = rounded_way(m, v);
    for (const PlaneSegment& o : segments_) {
      Aabb box;
      box.include(o.p);
      box.include(o.q);
      if (!meet(way, box)) continue;
      const Dyadic m_area = area(o.p, o.q, m);
      const int v_side = orientation_2d(o.p, o.q, v, axis_);
      if (m_area.sign() == 0) {
        if (v_side == 0) {
          consider(ray_position(m, v, o.p));
          consider(ray_position(m, v, o.q));
        }
        continue;
      }
      if (m_area.sign() * v_side >= 0 || !spans_ray(m, v, o)) continue;
      const Dyadic v_area = area(o.p, o.q, v) * m.w;
      consider(make_ratio(m_area, m_area - v_area));
    }
    return nearest;
  }

  // A box around the way from m to v, unbounded along the dropped axis. Spares exact work only.
  Aabb rounded_way(const PlanePoint& m, Vec3 v) const {
    double low[3] = {-INFINITY, -INFINITY, -INFINITY}, high[3] = {INFINITY, INFINITY, INFINITY};
    const auto bound = [&](int axis, const Dyadic& coordinate) {
      const double c = rounded_ratio(coordinate, m.w);
      const double error = kRatioError * std::fabs(c);
      low[axis] = std::fmin(c - error, v[axis]);
      high[axis] = std::fmax(c + error, v[axis]);
    };
    bound(i_, m.x);
    bound(j_, m.y);
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
  }

  // m + fraction * length * (v - m)
  PlanePoint along_ray(const PlanePoint& m, Vec3 v, const Ratio& length, double fraction) const {
    const Dyadic step = length.numerator * fraction;
    const auto along = [&](const Dyadic& from, double to) {
      return from * length.denominator + (m.w * to - from) * step;
    };
    return {along(m.x, v[i_]), along(m.y, v[j_]), m.w * length.denominator};
  }

  // Are the ends of o on different sides of the line m v, or on it?
  bool spans_ray(const PlanePoint& m, Vec3 v, const PlaneSegment& o) const {
    const Dyadic di = m.w * v[i_] - m.x, dj = m.w * v[j_] - m.y;
    const auto side = [&](Vec3 p) {
      return (di * (m.w * p[j_] - m.y) - dj * (m.w * p[i_] - m.x)).sign();
    };
    return side(o.p) * side(o.q) <= 0;
  }

  // Position of u on the line from m to v, which it lies on.
  Ratio ray_position(const PlanePoint& m, Vec3 v, Vec3 u) const {
    const Dyadic di = m.w * v[i_] - m.x;
    if (di.sign() != 0) return make_ratio(m.w * u[i_] - m.x, di);
    return make_ratio(m.w * u[j_] - m.y, m.w * v[j_] - m.y);
  }

  ExactPoint lift(const PlanePoint& p) const {
    return weighted_point(triangle_[0], triangle_[1], triangle_[2],
                          area(triangle_[1], triangle_[2], p), area(triangle_[2], triangle_[0], p),
                          area(triangle_[0], triangle_[1], p));
  }

  const std::array<Vec3, 3>& triangle_;
  int axis_, i_, j_;
  int turn_;
  std::vector<PlaneSegment> segments_;
};

}  // namespace

bool visit_pieces(const std::array<Vec3, 3>& triangle, const std::vector<PlaneSegment>& cuts,
                  const std::function<bool(const PieceSampler&)>& visit) {
  return Pieces(triangle, cuts).visit(visit);
}

}  // namespace satcheck
