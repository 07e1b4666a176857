#include "mesh/outline.hpp"

#include <algorithm>
#include <bit>

#include "exact/dyadic.hpp"
#include "exact/exact_point.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

Vec2 flat(Vec3 p, PlaneAxes axes) { return {p[axes.i], p[axes.j]}; }
bool equal(Vec2 p, Vec2 q) { return p.x == q.x && p.y == q.y; }

// The axis along which all vertices are equally far from 0, and farthest; -1 if there is none.
int axis_of_ends(const std::vector<Vec3>& vertices) {
  const Vec3 first = vertices[0];
  int best = -1;
  for (int axis : {2, 0, 1}) {
    const double height = std::fabs(first[axis]);
    const auto at_end = [&](Vec3 p) { return std::fabs(p[axis]) == height; };
    const bool higher = height > (best < 0 ? 0 : std::fabs(first[best]));
    if (higher && std::all_of(vertices.begin(), vertices.end(), at_end)) best = axis;
  }
  return best;
}

// What follows each vertex on its end of the prism, the vertex above or below it, and the wall triangle.
struct Walls {
  std::vector<std::uint32_t> next, mate, triangle;
  bool fine = true;

  explicit Walls(std::size_t vertices) : next(vertices, kNoIndex), mate(vertices, kNoIndex), triangle(vertices, kNoIndex) {}

  // p and q at one end, r at the other one.
  void add(const Mesh& mesh, PlaneAxes axes, std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t t) {
    const Vec2 at_r = flat(mesh.vertices[r], axes);
    const bool over_p = equal(flat(mesh.vertices[p], axes), at_r), over_q = equal(flat(mesh.vertices[q], axes), at_r);
    fine = fine && over_p != over_q && next[p] == kNoIndex;
    next[p] = q;
    triangle[p] = t;
    mate[over_p ? p : q] = r;
    mate[r] = over_p ? p : q;
  }
};

Walls walls_of(const Mesh& mesh, int axis) {
  Walls walls(mesh.vertices.size());
  const auto is_top = [&](std::uint32_t v) { return mesh.vertices[v][axis] > 0; };
  for (std::uint32_t t = 0; t < mesh.triangles.size() && walls.fine; ++t) {
    const Triangle& c = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t p = c[k], q = c[(k + 1) % 3], r = c[(k + 2) % 3];
      if (is_top(p) == is_top(q) && is_top(q) != is_top(r)) walls.add(mesh, plane_axes(axis), p, q, r, t);
    }
  }
  return walls;
}

// The loops of the lower end. False unless the upper end has the same ones, in the other direction.
bool add_loops(const Mesh& mesh, const Walls& walls, Outline& outline) {
  const PlaneAxes axes = plane_axes(outline.axis);
  std::vector<bool> seen(mesh.vertices.size(), false);
  for (std::uint32_t start = 0; start < mesh.vertices.size(); ++start) {
    if (seen[start] || walls.next[start] == kNoIndex || mesh.vertices[start][outline.axis] > 0) continue;
    const auto first = static_cast<std::uint32_t>(outline.edges.size());
    for (std::uint32_t v = start; !seen[v];) {
      seen[v] = true;
      const std::uint32_t next = walls.next[v];
      if (next == kNoIndex || walls.mate[v] == kNoIndex || walls.mate[next] == kNoIndex) return false;
      const std::uint32_t over_next = walls.mate[next];
      if (walls.next[over_next] != walls.mate[v]) return false;
      outline.edges.push_back({flat(mesh.vertices[v], axes), flat(mesh.vertices[next], axes),
                               static_cast<std::uint32_t>(outline.edges.size() + 1),
                               {walls.triangle[v], walls.triangle[over_next]}});
      v = next;
    }
    if (!equal(outline.edges.back().to, outline.edges[first].from)) return false;
    outline.edges.back().next = first;
    outline.loops.push_back(first);
  }
  return !outline.edges.empty();
}

OutlineBox fill_boxes(Outline& outline, const OutlineNode& node) {
  OutlineBox box;
  const auto include = [&](Vec2 low, Vec2 high) {
    box.low = {smaller(low.x, box.low.x), smaller(low.y, box.low.y)};
    box.high = {larger(high.x, box.high.x), larger(high.y, box.high.y)};
  };
  if (node.is_leaf()) {
    for (std::uint32_t k = node.first; k < node.last; ++k) {
      for (Vec2 p : {outline.edges[k].from, outline.edges[k].to}) include(p, p);
    }
  } else {
    for (const bool second : {false, true}) {
      const OutlineBox half = fill_boxes(outline, node.half(second));
      include(half.low, half.high);
    }
  }
  return outline.boxes[node.index] = box;
}

void build_tree(Outline& outline) {
  outline.boxes.resize(2 * std::bit_ceil(outline.edges.size()));
  fill_boxes(outline, outline.root());
}

bool turns_back(const OutlineEdge& e, const OutlineEdge& next) {
  return orientation(e.from, e.to, next.to) == 0 && turn_sign({e.from.y, -e.from.x}, {e.to.y, -e.to.x}, next.from, next.to) < 0;
}

bool meets_itself(const Outline& outline) {
  const std::vector<OutlineEdge>& edges = outline.edges;
  bool meets = false;
  auto visit = [&](std::uint32_t i, std::uint32_t k) {
    if (i >= k) return true;
    const bool follows = edges[i].next == k, precedes = edges[k].next == i;
    if (follows || precedes) {
      meets = (follows && precedes) || turns_back(edges[follows ? i : k], edges[follows ? k : i]);
    } else {
      meets = classify(edges[i], edges[k]) != EdgeContact::none;
    }
    return !meets;
  };
  visit_meeting_edges(outline, outline.root(), outline, outline.root(), visit);
  return meets;
}

// Whether the loop has material only on its left. From its rightmost corner, no edge of its own is to the right.
bool bounds_material(const Outline& outline, std::uint32_t first) {
  std::uint32_t before = first;
  for (std::uint32_t k = first;;) {
    const Vec2 p = outline.edges[k].to, best = outline.edges[before].to;
    if (p.x > best.x || (p.x == best.x && p.y > best.y)) before = k;
    if ((k = outline.edges[k].next) == first) break;
  }
  const OutlineEdge &e = outline.edges[before], &next = outline.edges[e.next];
  const int around = outline.winding(outline.root(), {e.to, e.to});
  return around == (orientation(e.from, e.to, next.to) > 0 ? 0 : 1);
}

std::shared_ptr<const Outline> make_outline(const Surface& surface) {
  const Mesh& mesh = surface.mesh;
  if (!surface.solid || mesh.triangles.empty()) return nullptr;
  auto outline = std::make_shared<Outline>();
  outline->axis = axis_of_ends(mesh.vertices);
  if (outline->axis < 0) return nullptr;
  outline->height = std::fabs(mesh.vertices[0][outline->axis]);
  const Walls walls = walls_of(mesh, outline->axis);
  if (!walls.fine || !add_loops(mesh, walls, *outline)) return nullptr;
  build_tree(*outline);
  const OutlineBox& box = outline->boxes[outline->root().index];
  if (outline->height < larger(box.high.x - box.low.x, box.high.y - box.low.y)) return nullptr;
  const auto fits = [&](std::uint32_t loop) { return bounds_material(*outline, loop); };
  if (meets_itself(*outline) || !std::all_of(outline->loops.begin(), outline->loops.end(), fits)) return nullptr;
  return outline;
}

Dyadic area(Vec2 from, Vec2 to, Vec2 p) {
  const auto difference = [](double head, double tail) { return Dyadic(head) - Dyadic(tail); };
  return difference(to.x, from.x) * difference(p.y, from.y) - difference(to.y, from.y) * difference(p.x, from.x);
}

// The sign of a sum of two numbers of different signs, each off by this share of `size`; 0 if they nearly cancel.
constexpr double kCancels = 8 * kUnitRoundoff;
int plain_sign(double sum, double size) {
  const double bound = kCancels * size + kUnderflow;
  return sum > bound ? 1 : sum < -bound ? -1 : 0;
}

// Whether the point is not below y.
bool reaches(const MiddlePoint& m, double y) {
  if ((m.p.y >= y) == (m.q.y >= y)) return m.p.y >= y;
  const double by_p = m.p.y - y, by_q = m.q.y - y;
  if (const int sign = plain_sign(by_p + by_q, std::fabs(by_p) + std::fabs(by_q))) return sign > 0;
  return ((Dyadic(m.p.y) - Dyadic(y)) + (Dyadic(m.q.y) - Dyadic(y))).sign() >= 0;
}

bool lexicographically_less(Vec2 p, Vec2 q) { return p.x != q.x ? p.x < q.x : p.y < q.y; }

// Edges on one line.
EdgeContact classify_collinear(const OutlineEdge& e, const OutlineEdge& f) {
  const auto [e_low, e_high] = std::minmax(e.from, e.to, lexicographically_less);
  const auto [f_low, f_high] = std::minmax(f.from, f.to, lexicographically_less);
  const bool apart = lexicographically_less(e_high, f_low) || lexicographically_less(f_high, e_low);
  return apart ? EdgeContact::none : EdgeContact::touching;
}

}  // namespace

int side_of(Vec2 from, Vec2 to, const MiddlePoint& m) {
  const int at_p = orientation(from, to, m.p), at_q = orientation(from, to, m.q);
  if (at_p * at_q >= 0) return at_p != 0 ? at_p : at_q;
  const Vec2 along = to - from, p = m.p - from, q = m.q - from;
  const double size = std::fabs(along.x) * (std::fabs(p.y) + std::fabs(q.y)) + std::fabs(along.y) * (std::fabs(p.x) + std::fabs(q.x));
  if (const int sign = plain_sign(cross(along, p) + cross(along, q), size)) return sign;
  return (area(from, to, m.p) + area(from, to, m.q)).sign();
}

EdgeContact classify(const OutlineEdge& e, const OutlineEdge& f) {
  const int from = orientation(e.from, e.to, f.from), to = orientation(e.from, e.to, f.to);
  if (from * to > 0) return EdgeContact::none;
  if (from == 0 && to == 0) return classify_collinear(e, f);
  const int sides = orientation(f.from, f.to, e.from) * orientation(f.from, f.to, e.to);
  if (sides > 0) return EdgeContact::none;
  return from * to < 0 && sides < 0 ? EdgeContact::crossing : EdgeContact::touching;
}

// Edges that a ray to the right passes upwards count +1, downwards -1.
int Outline::winding(const OutlineNode& node, const MiddlePoint& m) const {
  const OutlineBox& box = boxes[node.index];
  const bool beside = box.low.y > larger(m.p.y, m.q.y) || box.high.y < smaller(m.p.y, m.q.y);
  if (beside || box.high.x < smaller(m.p.x, m.q.x)) return 0;
  if (!node.is_leaf()) return winding(node.half(false), m) + winding(node.half(true), m);
  int sum = 0;
  for (std::uint32_t k = node.first; k < node.last; ++k) {
    const OutlineEdge& e = edges[k];
    const bool above_from = reaches(m, e.from.y), above_to = reaches(m, e.to.y);
    if (above_from == above_to) continue;
    const int side = side_of(e.from, e.to, m);
    if (above_from && side > 0) ++sum;
    if (above_to && side < 0) --sum;
  }
  return sum;
}

const Outline* outline_of(const Surface& surface) {
  if (!surface.outline) return nullptr;
  LazyOutline& lazy = *surface.outline;
  std::call_once(lazy.once, [&] { lazy.made = make_outline(surface); });
  return lazy.made.get();
}

}  // namespace satcheck
