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
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/edge_table.hpp"
#include "base/key_sort.hpp"
#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/plane_cells.hpp"
#include "mesh/self_contact.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

// Measured steps of a hinge and a triangle, of one wing of a hinge, and of two triangles and a way.
constexpr std::uint64_t kHingeWork = 200, kWingWork = 50, kWayWork = 100;

// An edge with triangles in contact, and the opposite corner of each sheet at the edge.
struct Hinge {
  Vec3 p, q;
  std::vector<Vec3> wings;
  std::vector<std::uint32_t> triangles;
};

// The triangles of a closed surface that are sheets, by the cells into which their own surface cuts them. A triangle
// that is partly a sheet counts as a sheet, and unsure() is then true.
class Sheets {
 public:
  Sheets(const Surface& surface, const std::unordered_map<std::uint32_t, bool>& known, Budget* budget)
      : surface_(surface), budget_(budget) {
    for (const auto& [t, is_sheet] : known) known_[t] = {is_sheet, is_sheet};
  }

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
    known_[t] = {};
    // A triangle that meets no other has material on one side.
    if (is_collinear(corners(surface_.mesh, t), budget_) || !has_irregular_partners(surface_, t, budget_)) return;
    const PlaneCells cells({&surface_}, {0, t}, SinglePoints::left_out, budget_);
    Sheet patch{false, true};
    const auto include = [&](Sheet& sheet, std::uint32_t cell) {
      const auto sides = cells.beside(cell, 0);
      sheet.any = sheet.any || !sides || sides->is_sheet();
      sheet.all = sheet.all && sides && sides->is_sheet();
    };
    for (const std::uint32_t cell : cells.cells()) include(patch, cell);
    const bool is_mixed = patch.any != patch.all;
    for (const PatchTriangle& member : cells.members()) known_[member.triangle] = is_mixed ? Sheet{false, true} : patch;
    if (!is_mixed) return;
    for (const std::uint32_t cell : cells.cells()) {
      for (const PatchTriangle& member : cells.members_at(cells.inside(cell))) include(known_[member.triangle], cell);
    }
  }

  const Surface& surface_;
  Budget* budget_;
  std::unordered_map<std::uint32_t, Sheet> known_;
  bool unsure_ = false;
};

// Pairs of triangles, by the first one.
class Partners {
 public:
  explicit Partners(std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs) : pairs_(std::move(pairs)) {
    std::sort(pairs_.begin(), pairs_.end());
  }

  bool any(std::uint32_t t) const {
    const auto at = from(t);
    return at != pairs_.end() && at->first == t;
  }

  // The partners of all of them, each once.
  std::vector<std::uint32_t> of(const std::vector<std::uint32_t>& triangles) const {
    std::vector<std::uint32_t> partners;
    for (const std::uint32_t t : triangles) {
      for (auto at = from(t); at != pairs_.end() && at->first == t; ++at) partners.push_back(at->second);
    }
    sort_once(partners);
    return partners;
  }

  // Of a triangle of `triangles` and the partner t.
  std::uint32_t with(const std::vector<std::uint32_t>& triangles, std::uint32_t t) const {
    return *std::find_if(triangles.begin(), triangles.end(),
                         [&](std::uint32_t u) { return std::binary_search(pairs_.begin(), pairs_.end(), std::pair(u, t)); });
  }

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>>::const_iterator from(std::uint32_t t) const {
    return std::lower_bound(pairs_.begin(), pairs_.end(), std::pair(t, 0u));
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

// The hinges of sheets in contact.
class Hinges {
 public:
  Hinges(const Mesh& mesh, Sheets& sheets, const Partners& partners) {
    const EdgeTable edges(mesh.vertices.size(), mesh.triangles);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto h = edges.half_edges(e);
      const auto corner = [&](std::uint32_t half_edge, std::uint32_t step) {
        return mesh.triangles[half_edge / 3][(half_edge % 3 + step) % 3];
      };
      Hinge hinge{mesh.vertices[corner(h[0], 0)], mesh.vertices[corner(h[0], 1)], {}, {}};
      for (const std::uint32_t half_edge : h) {
        if (partners.any(half_edge / 3)) hinge.triangles.push_back(half_edge / 3);
      }
      if (hinge.triangles.empty()) continue;
      std::vector<std::uint32_t> across;  // front and back of a sheet have one corner
      for (const std::uint32_t half_edge : h) {
        if (sheets.include(half_edge / 3)) across.push_back(corner(half_edge, 2));
      }
      sort_once(across);
      for (const std::uint32_t v : across) hinge.wings.push_back(mesh.vertices[v]);
      for (const std::uint32_t t : hinge.triangles) by_triangle_[t].push_back(static_cast<std::uint32_t>(hinges_.size()));
      hinges_.push_back(std::move(hinge));
    }
  }

  const std::vector<Hinge>& all() const { return hinges_; }

  // The hinges at any of the triangles, each once.
  std::vector<std::uint32_t> at(const std::vector<std::uint32_t>& triangles) const {
    std::vector<std::uint32_t> numbers;
    for (const std::uint32_t t : triangles) {
      const auto here = by_triangle_.find(t);
      if (here != by_triangle_.end()) numbers.insert(numbers.end(), here->second.begin(), here->second.end());
    }
    sort_once(numbers);
    return numbers;
  }

 private:
  std::vector<Hinge> hinges_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> by_triangle_;
};

// Whether the segment p q, in the plane of t, passes through the open triangle.
bool runs_through(Vec3 p, Vec3 q, const Corners& t, Budget* budget) {
  const int axis = projection_axis(t[0], t[1], t[2], budget);
  const auto left_of = [&](Vec3 from, Vec3 to, Vec3 x) { return orientation_2d(from, to, x, axis, budget); };
  const int turn = left_of(t[0], t[1], t[2]);
  int left = 0, right = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 u = t[i], v = t[(i + 1) % 3];
    if (turn * left_of(u, v, p) <= 0 && turn * left_of(u, v, q) <= 0) return false;
    const int side = left_of(p, q, u);
    left += side > 0 ? 1 : 0;
    right += side < 0 ? 1 : 0;
  }
  return left > 0 && right > 0;
}

// Collinear segments that share more than a point.
bool share_length(const Hinge& a, const Hinge& b, Budget* budget) {
  if (!collinear(a.p, a.q, b.p, budget) || !collinear(a.p, a.q, b.q, budget)) return false;
  const int axis = a.p.x != a.q.x ? 0 : a.p.y != a.q.y ? 1 : 2;
  const auto low = [&](const Hinge& h) { return std::fmin(h.p[axis], h.q[axis]); };
  const auto high = [&](const Hinge& h) { return std::fmax(h.p[axis], h.q[axis]); };
  return low(a) < high(b) && low(b) < high(a);
}

// Whether two wings of A and two of B alternate. Wings in one half-plane count once, and not if both have one there.
bool alternate(const Hinge& a, const Hinge& b, Budget* budget) {
  std::vector<Vec3> wings;  // of A first
  std::size_t of_a = 0;
  for (const Hinge* hinge : {&a, &b}) {
    std::copy_if(hinge->wings.begin(), hinge->wings.end(), std::back_inserter(wings),
                 [&](Vec3 wing) { return !collinear(a.p, a.q, wing, budget); });
    if (hinge == &a) of_a = wings.size();
  }
  std::vector<bool> around;  // whether a half-plane has wings of A
  for (const auto& group : groups_around(a.p, a.q, wings, budget)) {
    const auto [first, last] = std::minmax_element(group.begin(), group.end());
    if ((*first < of_a) == (*last < of_a)) around.push_back(*first < of_a);
  }
  int changes = 0;
  for (std::size_t i = 0; i < around.size(); ++i) changes += around[i] != around[(i + 1) % around.size()] ? 1 : 0;
  return changes >= 4;
}

bool crosses_triangle(const Hinge& hinge, const Corners& t, Budget* budget) {
  const auto side = [&](Vec3 p) { return orientation(t[0], t[1], t[2], p, budget); };
  if (is_collinear(t, budget) || side(hinge.p) != 0 || side(hinge.q) != 0) return false;
  bool above = false, below = false;
  for (const Vec3& w : hinge.wings) {
    above = above || side(w) > 0;
    below = below || side(w) < 0;
  }
  return above && below && runs_through(hinge.p, hinge.q, t, budget);
}

// A triangle of A and one of B that meet at an edge along which the sheets cross.
std::optional<ContactPair> crossing_at_edge(const Surface& a, const Surface& b, const Hinges& hinges_a, const Hinges& hinges_b,
                                            const Partners& of_a, const Partners& of_b, Budget* budget) {
  for (const Hinge& h : hinges_a.all()) {
    const std::vector<std::uint32_t> partners = of_a.of(h.triangles);
    spend(budget, (kHingeWork + kWingWork * h.wings.size()) * partners.size());
    for (const std::uint32_t t : partners) {
      if (crosses_triangle(h, corners(b.mesh, t), budget)) return ContactPair{of_a.with(h.triangles, t), t};
    }
    for (const std::uint32_t number : hinges_b.at(partners)) {
      const Hinge& k = hinges_b.all()[number];
      spend(budget, kHingeWork);
      if (!share_length(h, k, budget)) continue;
      spend(budget, kWingWork * (h.wings.size() + k.wings.size()));
      if (!alternate(h, k, budget)) continue;
      for (const std::uint32_t t : k.triangles) {
        if (std::binary_search(partners.begin(), partners.end(), t)) return ContactPair{of_a.with(h.triangles, t), t};
      }
    }
  }
  for (const Hinge& k : hinges_b.all()) {
    const std::vector<std::uint32_t> partners = of_b.of(k.triangles);
    spend(budget, (kHingeWork + kWingWork * k.wings.size()) * partners.size());
    for (const std::uint32_t t : partners) {
      if (crosses_triangle(k, corners(a.mesh, t), budget)) return ContactPair{t, of_b.with(k.triangles, t)};
    }
  }
  return std::nullopt;
}

// A dot product of a direction and a normal, both unit: far more than the rounding of 0.
constexpr double kSurelyAlong = 0x1p-40;

Vec3 unit_normal(const Corners& t) {
  const Vec3 n = rounded_normal(t[0], t[1], t[2]);
  return n * (1 / norm(n));
}

// Whether the plane of t separates the two triangles, so that A leaves B when it moves along `way`. sign: 1 if t
// belongs to A, -1 if it belongs to B.
bool leaves_over(const Corners& t, const Corners& other, double sign, Vec3 way, Budget* budget) {
  const double along = sign * dot(unit_normal(t), way);
  if (std::fabs(along) < kSurelyAlong) return false;
  // If A moves to the front of its own triangle (along > 0), B has to lie behind it or in its plane.
  const int free_side = along > 0 ? -1 : 1;
  return std::all_of(other.begin(), other.end(), [&](Vec3 p) {
    const int side = orientation(t[0], t[1], t[2], p, budget);
    return side == 0 || side == free_side;
  });
}

// Adds a normal to those of up to three different directions.
void take(Vec3 normal, std::vector<Vec3>& chosen) {
  const auto parallel = [&](Vec3 m) { return std::fabs(dot(m, normal)) > 1 - kSurelyAlong; };
  if (chosen.size() < 3 && std::none_of(chosen.begin(), chosen.end(), parallel)) chosen.push_back(normal);
}

// Sums of the normals, with both signs.
std::vector<Vec3> ways_out(const std::vector<Vec3>& normals) {
  std::vector<Vec3> ways{{}};
  for (const Vec3& n : normals) {
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

}  // namespace

void find_sheet_crossing(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts, Samples& samples,
                         Budget* budget) {
  Sheets of_a(a, samples.is_sheet(0), budget), of_b(b, samples.is_sheet(1), budget);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs, mirrored;
  for (const ContactPair& c : contacts) {
    if (!of_a.include(c.a) || !of_b.include(c.b)) continue;
    pairs.emplace_back(c.a, c.b);
    mirrored.emplace_back(c.b, c.a);
  }
  if (pairs.empty()) return;
  const Partners partners_a(pairs), partners_b(std::move(mirrored));
  const Hinges hinges_a(a.mesh, of_a, partners_a), hinges_b(b.mesh, of_b, partners_b);
  if (const auto crossing = crossing_at_edge(a, b, hinges_a, hinges_b, partners_a, partners_b, budget)) {
    if (of_a.unsure() || of_b.unsure()) return samples.fail();
    samples.note_sheets_cross([&] {
      return Evidence{crossing->a, crossing->b, contact_point(corners(a.mesh, crossing->a), corners(b.mesh, crossing->b))};
    });
    return;
  }
  std::vector<Vec3> flat;  // normals of coplanar triangles that overlap
  for (const auto& [ta, tb] : pairs) {
    spend(budget, kWayWork);
    const Corners c = corners(a.mesh, ta);
    if (coplanar_overlap(c, corners(b.mesh, tb), budget) != CoplanarOverlap::none) take(unit_normal(c), flat);
  }
  if (flat.empty()) return;
  const std::vector<Vec3> ways = ways_out(flat);
  const bool frees = std::any_of(ways.begin(), ways.end(), [&](Vec3 way) {
    return std::all_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
      spend(budget, kWayWork);
      const Corners c = corners(a.mesh, pair.first), d = corners(b.mesh, pair.second);
      return leaves_over(c, d, 1, way, budget) || leaves_over(d, c, -1, way, budget);
    });
  });
  if (!frees) samples.fail();
}

}  // namespace satcheck
