// Near an interior point, a surface is a disk that divides its surroundings in two. Two such disks that share only one
// point do not cross, because a disk without one point is connected. A crossing therefore runs along a segment. If no
// two open triangles cross, the segment lies on an edge:
//
// * an edge of one sheet in a triangle of the other: they cross if triangles at the edge leave to
//   strictly different sides of that triangle's plane;
// * on edges of both: they cross if, turning around the common line, triangles of one sheet
//   alternate with those of the other.
//
// If triangles of both coincide in a patch, a crossing may lead through that patch. There is none if an arbitrarily
// small translation in some direction separates A from every triangle of B that it meets.
#include "mesh_pair/sheet_contact.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include "base/edge_table.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/plane_cells.hpp"
#include "mesh/self_contact.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

// An edge, and the opposite corner of each triangle at the edge.
struct Hinge {
  Vec3 p, q;
  std::vector<Vec3> wings;
};

// The triangles of a closed surface that are sheets, by the cells into which their own surface cuts them. A triangle
// that is partly a sheet counts as a sheet, and unsure() is then true.
class Sheets {
 public:
  Sheets(const Surface& surface, Budget* budget) : surface_(surface), budget_(budget) {}

  bool include(std::uint32_t t) {
    if (!known_.contains(t)) look_at(t);
    const auto [any, all] = known_.at(t);
    unsure_ = unsure_ || any != all;
    return any;
  }

  bool unsure() const { return unsure_; }

 private:
  struct Sheet {
    bool any = false, all = false;
  };

  void look_at(std::uint32_t t) {
    const Corners c = corners(surface_.mesh, t);
    known_[t] = {};
    // A triangle that meets no other has material on one side.
    if (collinear(c[0], c[1], c[2]) || !has_irregular_partners(surface_, t, budget_)) return;
    const PlaneCells cells({&surface_}, {0, t}, SinglePoints::left_out, budget_);
    const auto sheet_of = [&](const std::vector<std::uint32_t>& outlines) {
      Sheet sheet{false, true};
      for (const std::uint32_t outline : outlines) {
        const auto sides = cells.beside(outline, 0);
        sheet.any = sheet.any || !sides || sides->is_sheet();
        sheet.all = sheet.all && sides && sides->is_sheet();
      }
      return sheet;
    };
    const Sheet patch = sheet_of(cells.outlines());
    for (const PatchTriangle& member : cells.members()) {
      known_[member.triangle] = patch.any == patch.all ? patch : sheet_of(cells.outlines_in(member));
    }
  }

  const Surface& surface_;
  Budget* budget_;
  std::unordered_map<std::uint32_t, Sheet> known_;
  bool unsure_ = false;
};

// The hinges of sheets in contact, by triangle.
class Hinges {
 public:
  Hinges(const Mesh& mesh, Sheets& sheets, const std::vector<std::uint32_t>& triangles) {
    std::vector<bool> wanted(mesh.triangles.size(), false);
    for (const std::uint32_t t : triangles) wanted[t] = true;
    const EdgeTable edges(mesh.vertices.size(), mesh.triangles);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto h = edges.half_edges(e);
      if (std::none_of(h.begin(), h.end(), [&](std::uint32_t half_edge) { return wanted[half_edge / 3]; })) continue;
      const auto corner = [&](std::uint32_t half_edge, std::uint32_t step) {
        return mesh.triangles[half_edge / 3][(half_edge % 3 + step) % 3];
      };
      std::vector<std::uint32_t> across;  // front and back of a sheet have one corner
      for (const std::uint32_t half_edge : h) {
        if (sheets.include(half_edge / 3)) across.push_back(corner(half_edge, 2));
      }
      std::sort(across.begin(), across.end());
      across.erase(std::unique(across.begin(), across.end()), across.end());
      Hinge hinge{mesh.vertices[corner(h[0], 0)], mesh.vertices[corner(h[0], 1)], {}};
      for (const std::uint32_t v : across) hinge.wings.push_back(mesh.vertices[v]);
      for (const std::uint32_t half_edge : h) by_triangle_[half_edge / 3].push_back(hinges_.size());
      hinges_.push_back(std::move(hinge));
    }
  }

  // Whether `holds` is true for a hinge at the triangle.
  template <class Holds>
  bool any_at(std::uint32_t triangle, Holds holds) const {
    const auto at = by_triangle_.find(triangle);
    return at != by_triangle_.end() &&
           std::any_of(at->second.begin(), at->second.end(), [&](std::size_t k) { return holds(hinges_[k]); });
  }

 private:
  std::vector<Hinge> hinges_;
  std::unordered_map<std::uint32_t, std::vector<std::size_t>> by_triangle_;  // numbers of hinges: many pages may share one
};

// Whether the segment p q, in the plane of t, passes through the open triangle.
bool runs_through(Vec3 p, Vec3 q, const Corners& t) {
  const int axis = projection_axis(rounded_normal(t[0], t[1], t[2]));
  const int turn = orientation_2d(t[0], t[1], t[2], axis);
  int left = 0, right = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 u = t[i], v = t[(i + 1) % 3];
    if (turn * orientation_2d(u, v, p, axis) <= 0 && turn * orientation_2d(u, v, q, axis) <= 0) return false;
    const int side = orientation_2d(p, q, u, axis);
    left += side > 0 ? 1 : 0;
    right += side < 0 ? 1 : 0;
  }
  return left > 0 && right > 0;
}

// Collinear segments that share more than a point.
bool share_length(const Hinge& a, const Hinge& b) {
  if (!collinear(a.p, a.q, b.p) || !collinear(a.p, a.q, b.q)) return false;
  const int axis = a.p.x != a.q.x ? 0 : a.p.y != a.q.y ? 1 : 2;
  const auto low = [&](const Hinge& h) { return std::fmin(h.p[axis], h.q[axis]); };
  const auto high = [&](const Hinge& h) { return std::fmax(h.p[axis], h.q[axis]); };
  return low(a) < high(b) && low(b) < high(a);
}

// Whether a rotation about the line p q from wing u meets x before v. orientation(p, q, u, w) > 0 if the rotation from
// u to w is less than half a turn.
bool strictly_between(Vec3 p, Vec3 q, Vec3 u, Vec3 v, Vec3 x) {
  const int u_v = orientation(p, q, u, v), u_x = orientation(p, q, u, x), x_v = orientation(p, q, x, v);
  if (u_v > 0) return u_x > 0 && x_v > 0;
  if (u_v < 0) return u_x > 0 || x_v > 0;
  return u_x > 0;  // u and v opposite each other
}

bool same_half_plane(Vec3 p, Vec3 q, Vec3 u, Vec3 v) {
  if (orientation(p, q, u, v) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int side = orientation_2d(p, q, u, axis);
    if (side != 0) return side == orientation_2d(p, q, v, axis);
  }
  return true;  // a collinear triangle has no sides
}

// Whether two wings of A and two of B alternate.
bool alternate(const Hinge& a, const Hinge& b) {
  const Vec3 p = a.p, q = a.q;
  const auto lies_in = [&](Vec3 u, const std::vector<Vec3>& wings) {
    return std::any_of(wings.begin(), wings.end(), [&](Vec3 w) { return same_half_plane(p, q, u, w); });
  };
  std::vector<Vec3> of_a, of_b;
  for (const Vec3& u : a.wings) {
    if (!lies_in(u, b.wings) && !lies_in(u, of_a)) of_a.push_back(u);
  }
  for (const Vec3& x : b.wings) {
    if (!lies_in(x, a.wings)) of_b.push_back(x);
  }
  for (std::size_t j = 1; j < of_a.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const auto between = [&](Vec3 x) { return strictly_between(p, q, of_a[i], of_a[j], x); };
      const auto count = std::count_if(of_b.begin(), of_b.end(), between);
      if (count != 0 && count != std::ptrdiff_t(of_b.size())) return true;
    }
  }
  return false;
}

bool crosses_triangle(const Hinge& hinge, const Corners& t) {
  const auto side = [&](Vec3 p) { return orientation(t[0], t[1], t[2], p); };
  if (collinear(t[0], t[1], t[2]) || side(hinge.p) != 0 || side(hinge.q) != 0) return false;
  bool above = false, below = false;
  for (const Vec3& w : hinge.wings) {
    above = above || side(w) > 0;
    below = below || side(w) < 0;
  }
  return above && below && runs_through(hinge.p, hinge.q, t);
}

struct SheetPair {
  std::uint32_t a, b;
  Corners of_a, of_b;
};

bool crosses_at_edge(const SheetPair& pair, const Hinges& hinges_a, const Hinges& hinges_b) {
  const auto crosses = [&](const Hinge& h) {
    return crosses_triangle(h, pair.of_b) ||
           hinges_b.any_at(pair.b, [&](const Hinge& k) { return share_length(h, k) && alternate(h, k); });
  };
  return hinges_a.any_at(pair.a, crosses) ||
         hinges_b.any_at(pair.b, [&](const Hinge& k) { return crosses_triangle(k, pair.of_a); });
}

// A dot product of a direction and a normal, both unit: far more than the rounding of 0.
constexpr double kSurelyAlong = 0x1p-40;

Vec3 unit_normal(const Corners& t) {
  const Vec3 n = rounded_normal(t[0], t[1], t[2]);
  return n * (1 / norm(n));
}

// Whether the plane of t separates the two triangles, so that A leaves B when it moves along `way`. sign: 1 if t
// belongs to A, -1 if it belongs to B.
bool leaves_over(const Corners& t, const Corners& other, double sign, Vec3 way) {
  const double along = sign * dot(unit_normal(t), way);
  if (std::fabs(along) < kSurelyAlong) return false;
  // If A moves to the front of its own triangle (along > 0), B has to lie behind it or in its plane.
  const int free_side = along > 0 ? -1 : 1;
  return std::all_of(other.begin(), other.end(), [&](Vec3 p) {
    const int side = orientation(t[0], t[1], t[2], p);
    return side == 0 || side == free_side;
  });
}

bool leaves(const SheetPair& pair, Vec3 way) {
  return leaves_over(pair.of_a, pair.of_b, 1, way) || leaves_over(pair.of_b, pair.of_a, -1, way);
}

// Sums of up to three different normals, with both signs.
std::vector<Vec3> ways_out(const std::vector<Vec3>& normals) {
  std::vector<Vec3> chosen;
  for (const Vec3& n : normals) {
    const auto parallel = [&](Vec3 m) { return std::fabs(dot(m, n)) > 1 - kSurelyAlong; };
    if (chosen.size() < 3 && std::none_of(chosen.begin(), chosen.end(), parallel)) chosen.push_back(n);
  }
  std::vector<Vec3> ways{{}};
  for (const Vec3& n : chosen) {
    const std::size_t count = ways.size();
    for (std::size_t i = 0; i < count; ++i) {
      ways.push_back(ways[i] + n);
      ways.push_back(ways[i] - n);
    }
  }
  std::erase(ways, Vec3{});
  for (Vec3& way : ways) way = way * (1 / norm(way));
  return ways;
}

std::vector<SheetPair> sheet_pairs(const Surface& a, const Surface& b, Sheets& of_a, Sheets& of_b,
                                   const std::vector<ContactPair>& contacts) {
  std::vector<SheetPair> pairs;
  for (const ContactPair& c : contacts) {
    if (of_a.include(c.a) && of_b.include(c.b)) pairs.push_back({c.a, c.b, corners(a.mesh, c.a), corners(b.mesh, c.b)});
  }
  return pairs;
}

template <class Member>
std::vector<std::uint32_t> triangles_of(const std::vector<SheetPair>& pairs, Member side) {
  std::vector<std::uint32_t> result;
  for (const SheetPair& pair : pairs) result.push_back(pair.*side);
  return result;
}

}  // namespace

void find_sheet_crossing(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts, Samples& samples,
                         Budget* budget) {
  Sheets of_a(a, budget), of_b(b, budget);
  const std::vector<SheetPair> pairs = sheet_pairs(a, b, of_a, of_b, contacts);
  if (pairs.empty()) return;
  const Hinges hinges_a(a.mesh, of_a, triangles_of(pairs, &SheetPair::a));
  const Hinges hinges_b(b.mesh, of_b, triangles_of(pairs, &SheetPair::b));
  std::vector<Vec3> flat;  // normals of coplanar triangles that overlap
  for (const SheetPair& pair : pairs) {
    if (crosses_at_edge(pair, hinges_a, hinges_b)) {
      if (of_a.unsure() || of_b.unsure()) return samples.fail();
      samples.note_sheets_cross([&] { return Evidence{pair.a, pair.b, contact_point(pair.of_a, pair.of_b)}; });
      return;
    }
    if (coplanar_overlap(pair.of_a, pair.of_b) != CoplanarOverlap::none) flat.push_back(unit_normal(pair.of_a));
  }
  if (flat.empty()) return;
  const std::vector<Vec3> ways = ways_out(flat);
  const bool frees = std::any_of(ways.begin(), ways.end(), [&](Vec3 way) {
    return std::all_of(pairs.begin(), pairs.end(), [&](const SheetPair& pair) { return leaves(pair, way); });
  });
  if (!frees) samples.fail();
}

}  // namespace satcheck
