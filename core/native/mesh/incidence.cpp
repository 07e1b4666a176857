#include "mesh/incidence.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/surface.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

// The place of a point in a triangle: a corner 0, 1, 2, the edge 3 + i that starts at corner i, or:
constexpr int kFace = 6;
constexpr int kOutside = -1;

// The place by the sides of the three edges; mixed sides mean outside.
int place_in_triangle(const int (&side)[3]) {
  bool positive = false, negative = false;
  int zeros = 0, zero = 0;
  for (int i = 0; i < 3; ++i) {
    positive = positive || side[i] > 0;
    negative = negative || side[i] < 0;
    if (side[i] == 0) {
      ++zeros;
      zero = i;
    }
  }
  if (positive && negative) return kOutside;
  if (zeros == 0) return kFace;
  if (zeros == 1) return 3 + zero;
  return side[0] == 0 && side[1] == 0 ? 1 : side[1] == 0 && side[2] == 0 ? 2 : 0;
}

// A triangle with numbers and coordinates of its corners.
struct Facet {
  Facet(const Mesh& mesh, std::uint32_t t)
      : number(t), vertex(mesh.triangles[t]), corner(corners(mesh, t)) {
    is_collinear = collinear(corner[0], corner[1], corner[2]);
    axis = projection_axis(corner[0], corner[1], corner[2]);
  }

  MeshFeature edge(int i) const { return MeshFeature::edge(vertex[i], vertex[(i + 1) % 3]); }
  MeshFeature feature(int place) const {
    if (place == kFace) return {MeshFeature::kInside, number};
    return place < 3 ? MeshFeature{vertex[place], vertex[place]} : edge(place - 3);
  }

  std::uint32_t number;
  Triangle vertex;
  Corners corner;
  bool is_collinear;
  int axis;
};

// The common part of a closed edge and a closed triangle: nothing, a point, or a segment in the order of the edge.
// Ranks give the order of points on the edge.
class EdgeMeeting {
 public:
  EdgeMeeting(const Facet& of, int edge, const Facet& triangle, bool edge_is_of_a)
      : own_(of.edge(edge)),
        first_{of.vertex[edge], of.vertex[edge]},
        last_{of.vertex[(edge + 1) % 3], of.vertex[(edge + 1) % 3]},
        p_(of.corner[edge]),
        q_(of.corner[(edge + 1) % 3]),
        t_(triangle),
        edge_is_of_a_(edge_is_of_a) {
    if (first_ == last_) return;
    const auto& [t0, t1, t2] = t_.corner;
    const int sp = orientation(t0, t1, t2, p_), sq = orientation(t0, t1, t2, q_);
    if (sp == 0 && sq == 0) {
      in_plane = true;
      meet_in_plane();
    } else if (sp * sq < 0) {
      pierce();
    } else if (sp == 0) {
      place_end(first_, p_, kStart);
    } else if (sq == 0) {
      place_end(last_, q_, kEnd);
    }
  }

  int count = 0;
  Incidence node[2];
  bool in_plane = false;

 private:
  // On the edge a corner of the triangle is behind where the edge enters it, and before it leaves.
  enum Rank { kStart, kEntry, kCorner, kExit, kEnd };

  void add(MeshFeature own, int place, Rank rank, Vec3 corner = {}) {
    const MeshFeature other = t_.feature(place);
    const Incidence incidence = edge_is_of_a_ ? Incidence{own, other} : Incidence{other, own};
    if (count > 0 && node[0] == incidence) return;
    if (count == 2) return;  // convex: a third one is one of the two
    node[count] = incidence;
    rank_[count] = rank;
    corner_[count] = corner;
    if (++count == 2 && in_order(1, 0)) std::swap(node[0], node[1]);
  }

  bool in_order(int i, int k) const {
    if (rank_[i] != rank_[k]) return rank_[i] < rank_[k];
    return coordinates_less(corner_[i], corner_[k]) == coordinates_less(p_, q_);
  }

  void place_end(MeshFeature end, Vec3 point, Rank rank) {
    int side[3];
    for (int i = 0; i < 3; ++i) side[i] = flat(t_.corner[i], t_.corner[(i + 1) % 3], point);
    const int place = place_in_triangle(side);
    if (place != kOutside) add(end, place, rank);
  }

  void pierce() {
    int side[3];
    for (int i = 0; i < 3; ++i) side[i] = orientation(p_, q_, t_.corner[i], t_.corner[(i + 1) % 3]);
    const int place = place_in_triangle(side);
    if (place != kOutside) add(own_, place, kCorner);
  }

  void meet_in_plane() {
    place_end(first_, p_, kStart);
    place_end(last_, q_, kEnd);
    const int turn = flat(t_.corner[0], t_.corner[1], t_.corner[2]);
    int side[3];
    for (int i = 0; i < 3; ++i) side[i] = flat(p_, q_, t_.corner[i]);
    for (int i = 0; i < 3; ++i) {
      const Vec3 r = t_.corner[i], s = t_.corner[(i + 1) % 3];
      if (side[i] == 0 && coordinates_less(p_, r) != coordinates_less(q_, r) && r != p_ && r != q_) {
        add(own_, i, kCorner, r);
      }
      if (side[i] * side[(i + 1) % 3] >= 0) continue;
      const int side_p = flat(r, s, p_), side_q = flat(r, s, q_);
      if (side_p * side_q < 0) add(own_, 3 + i, side_p * turn < 0 ? kEntry : kExit);
    }
  }

  int flat(Vec3 a, Vec3 b, Vec3 c) const { return orientation_2d(a, b, c, t_.axis); }

  MeshFeature own_, first_, last_;
  Vec3 p_, q_;
  const Facet& t_;
  bool edge_is_of_a_;
  Rank rank_[2];
  Vec3 corner_[2];
};

void add_once(std::vector<Incidence>& nodes, const Incidence& node) {
  if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
}

// A collinear triangle has an edge that covers the other two.
int longest_edge(const Facet& f) {
  int best = 0;
  for (int i = 1; i < 3; ++i) {
    const auto length = [&](int k) { return max_abs(f.corner[(k + 1) % 3] - f.corner[k]); };
    if (length(i) > length(best)) best = i;
  }
  return best;
}

TriangleMeeting meet_collinear(const Facet& line, const Facet& triangle, bool line_is_of_a) {
  TriangleMeeting result;
  const int longest = longest_edge(line);
  const EdgeMeeting covering(line, longest, triangle, line_is_of_a);
  for (int k = 0; k < covering.count; ++k) add_once(result.nodes, covering.node[k]);
  if (covering.count == 2) {
    result.kind = MeetingKind::segment;
    return result;
  }
  if (!covering.in_plane) {
    for (int i = 0; i < 3; ++i) {
      if (i == longest) continue;
      const EdgeMeeting other(line, i, triangle, line_is_of_a);
      for (int k = 0; k < other.count; ++k) add_once(result.nodes, other.node[k]);
    }
  }
  if (!result.nodes.empty()) result.kind = MeetingKind::point;
  return result;
}

bool is_even(double value) { return (std::bit_cast<std::uint64_t>(value) & 1) == 0; }

// numerator / denominator to nearest, ties to even; denominator > 0.
double nearest_float(const Dyadic& numerator, const Dyadic& denominator) {
  double value = rounded_ratio(numerator, denominator);
  const Dyadic twice = numerator * 2.0;
  for (const double end : {INFINITY, -INFINITY}) {
    const int direction = end > 0 ? 1 : -1;
    for (;;) {
      const double next = std::nextafter(value, end);
      const int beyond = direction * (twice - (Dyadic(value) + next) * denominator).sign();
      if (beyond < 0 || (beyond == 0 && is_even(value))) break;
      value = next;
    }
  }
  return value;
}

ExactPoint cross_edges(Vec3 p, Vec3 q, Vec3 r, Vec3 s) {
  const int first = projection_axis(cross(q - p, s - r));
  for (int k = 0; k < 3; ++k) {
    const int axis = (first + k) % 3;
    if (orientation_2d(r, s, p, axis) == orientation_2d(r, s, q, axis)) continue;
    return crossing_point(make_exact_point(p), make_exact_point(q), make_exact_point(r), make_exact_point(s), axis);
  }
  return make_exact_point(p);  // parallel edges do not cross
}

}  // namespace

TriangleMeeting meet_triangles(const Mesh& mesh_a, std::uint32_t triangle_a, const Mesh& mesh_b,
                               std::uint32_t triangle_b) {
  if (classify(corners(mesh_a, triangle_a), corners(mesh_b, triangle_b)) == TriangleContact::disjoint) return {};
  const Facet a(mesh_a, triangle_a), b(mesh_b, triangle_b);
  if (a.is_collinear && b.is_collinear) return {};
  if (a.is_collinear) return meet_collinear(a, b, true);
  if (b.is_collinear) return meet_collinear(b, a, false);
  TriangleMeeting result;
  const CoplanarOverlap overlap = coplanar_overlap(a.corner, b.corner);
  result.opposed = overlap == CoplanarOverlap::opposing;
  for (const bool of_a : {true, false}) {
    for (int i = 0; i < 3; ++i) {
      const EdgeMeeting m = of_a ? EdgeMeeting(a, i, b, true) : EdgeMeeting(b, i, a, false);
      for (int k = 0; k < m.count; ++k) add_once(result.nodes, m.node[k]);
      if (overlap == CoplanarOverlap::none || m.count < 2) continue;
      const bool backward = !of_a && result.opposed;
      const MeetingSide side = backward ? MeetingSide{m.node[1], m.node[0]} : MeetingSide{m.node[0], m.node[1]};
      if (std::find(result.sides.begin(), result.sides.end(), side) == result.sides.end()) {
        result.sides.push_back(side);
      }
    }
  }
  if (overlap != CoplanarOverlap::none) {
    result.kind = MeetingKind::patch;
  } else if (!result.nodes.empty()) {
    result.kind = result.nodes.size() == 1 ? MeetingKind::point : MeetingKind::segment;
  }
  return result;
}

ExactPoint place_of(const Incidence& at, const Mesh& a, const Mesh& b) {
  const auto end = [](const Mesh& mesh, std::uint32_t v) { return mesh.vertices[v]; };
  if (at.a.is_vertex()) return make_exact_point(end(a, at.a.first));
  if (at.b.is_vertex()) return make_exact_point(end(b, at.b.first));
  if (at.a.is_edge() && at.b.is_edge()) {
    return cross_edges(end(a, at.a.first), end(a, at.a.second), end(b, at.b.first), end(b, at.b.second));
  }
  const bool edge_of_a = at.a.is_edge();
  const Mesh &of = edge_of_a ? a : b, &other = edge_of_a ? b : a;
  const MeshFeature edge = edge_of_a ? at.a : at.b, face = edge_of_a ? at.b : at.a;
  const Corners t = corners(other, face.second);
  return plane_meeting_point(t[0], t[1], t[2], end(of, edge.first), end(of, edge.second));
}

ExactPoint locate(const Incidence& at, const Mesh& a, const Mesh& b) {
  ExactPoint p = place_of(at, a, b);
  p.rounded = {nearest_float(p.x, p.w), nearest_float(p.y, p.w), nearest_float(p.z, p.w)};
  return p;
}

bool straight(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r) {
  constexpr double kBent = 1e-6;  // only avoids exact work: a straight line is never this bent
  const Vec3 u = q.rounded - p.rounded, v = r.rounded - q.rounded;
  if (dot(u, v) <= 0 || norm(cross(u, v)) > kBent * norm(u) * norm(v)) return false;
  const Dyadic ux = q.x * p.w - p.x * q.w, uy = q.y * p.w - p.y * q.w, uz = q.z * p.w - p.z * q.w;
  const Dyadic vx = r.x * p.w - p.x * r.w, vy = r.y * p.w - p.y * r.w, vz = r.z * p.w - p.z * r.w;
  return (ux * vy - uy * vx).sign() == 0 && (uy * vz - uz * vy).sign() == 0 &&
         (uz * vx - ux * vz).sign() == 0;
}

}  // namespace satcheck
