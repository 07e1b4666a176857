#include "overlap/space_cells.hpp"

#include <algorithm>
#include <map>

#include "base/edge_table.hpp"
#include "base/key_sort.hpp"
#include "mesh_pair/traversal.hpp"

namespace satcheck {
namespace {

// Measured steps of two triangles that meet, and of a half-plane at a stretch.
constexpr std::uint64_t kMeetingWork = 4000, kHalfPlaneWork = 500;

LazyPoint lazy(const ExactPoint& p) {
  return {p.rounded, p.error, [&p] { return p; }};
}

}  // namespace

TriangleFaces::TriangleFaces(const MeetingNodes& nodes, int mesh, const Triangle& triangle, const Corners& corners,
                             const std::vector<NodePair>& segments, Budget* budget)
    : graph_(corners, budget) {
  std::map<std::uint32_t, std::uint32_t> numbers;
  std::vector<int> on_sides;  // of each node of the graph: bit i for side i
  const auto node = [&](std::uint32_t name, int bits) {
    const auto [known, is_new] = numbers.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) {
      names_.push_back(name);
      on_sides.push_back(0);
      graph_.add_node(lazy(nodes.at(name)));
    }
    on_sides[known->second] |= bits;
    return known->second;
  };
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t first = triangle[i], last = triangle[(i + 1) % 3];
    const std::uint32_t from = node(nodes.of_vertex(mesh, first), 1 << i), to = node(nodes.of_vertex(mesh, last), 1 << i);
    corners_.push_back(from);
    graph_.add_segment(from, to, 0, {});
    for (const std::uint32_t name : nodes.inside(mesh, MeshFeature::edge(first, last))) {
      graph_.add_stop(from, to, node(name, 1 << i));
    }
  }
  for (const auto& [low, high] : segments) {
    const std::uint32_t from = node(low, 0), to = node(high, 0);
    if ((on_sides[from] & on_sides[to]) == 0) graph_.add_segment(from, to, 0, {});
  }
  graph_.build_named();
  std::uint32_t along = 0;  // the first side
  while (graph_.segment(along) != 0 || graph_.start(along) != corners_[0]) ++along;
  outside_ = graph_.face(along ^ 1);
}

ExactPoint TriangleFaces::sample(std::uint32_t face) const {
  return *graph_.inside_left_of(graph_.first(face < outside_ ? face : face + 1), corners_, 0);
}

std::optional<std::uint32_t> TriangleFaces::face_at(const ExactPoint& p) const {
  if (count() == 1) return 0;
  const auto face = graph_.face_at(lazy(p));
  return face ? std::optional(name_of(*face)) : std::nullopt;
}

SpaceCells::SpaceCells(const Surface& a, const Surface& b, std::size_t max_pairs, Budget* budget)
    : a_(a), b_(b), budget_(budget), nodes_(a.mesh, b.mesh) {
  meet(max_pairs);
  for (int mesh = 0; mesh < 2 && complete_; ++mesh) cut(mesh);
  shells_ = DisjointSets(2 * faces_.size());
  for (int mesh = 0; mesh < 2 && complete_; ++mesh) join_at_edges(mesh);
  if (complete_) join_at_stretches();
}

void SpaceCells::meet(std::size_t max_pairs) {
  for (const int mesh : {0, 1}) cut_[mesh].assign(surface(mesh).mesh.triangles.size(), kNotCut);
  const std::vector<ContactPair> pairs = find_contacts(a_, b_, AtCrossing::go_on, budget_).contacts;
  complete_ = within_limits_ = pairs.size() <= max_pairs;
  if (!complete_) return;
  spend(budget_, kMeetingWork * pairs.size());
  for (const ContactPair& pair : pairs) {
    if (repeats_a_corner(a_.mesh.triangles[pair.a]) || repeats_a_corner(b_.mesh.triangles[pair.b])) continue;
    const TriangleMeeting meeting = meet_triangles(a_.mesh, pair.a, b_.mesh, pair.b);
    std::vector<NodePair> segments;
    std::vector<std::uint32_t> at;
    for (const Incidence& node : meeting.nodes) at.push_back(nodes_.add(node));
    if (meeting.kind == MeetingKind::segment) segments.emplace_back(at[0], at[1]);
    for (const MeetingSide& side : meeting.sides) segments.emplace_back(nodes_.add(side.from), nodes_.add(side.to));
    for (auto [low, high] : segments) {
      if (high < low) std::swap(low, high);
      segments_[0].emplace_back(pair.a, NodePair{low, high});
      segments_[1].emplace_back(pair.b, NodePair{low, high});
    }
    cut_[0][pair.a] = cut_[1][pair.b] = 0;
  }
  for (auto& segments : segments_) sort_once(segments);
}

// The faces of all triangles of one mesh.
void SpaceCells::cut(int mesh) {
  const Mesh& m = surface(mesh).mesh;
  first_face_[mesh].reserve(m.triangles.size());
  for (std::uint32_t t = 0; t < m.triangles.size() && complete_; ++t) {
    const auto first = static_cast<std::uint32_t>(faces_.size());
    first_face_[mesh].push_back(first);
    const std::uint32_t count = in_contact(mesh, t) ? cut_triangle(mesh, t) : 1;
    for (std::uint32_t k = 0; k < count; ++k) faces_.push_back({mesh, t, k});
  }
}

// The number of its faces.
std::uint32_t SpaceCells::cut_triangle(int mesh, std::uint32_t triangle) {
  const Corners c = corners(surface(mesh).mesh, triangle);
  complete_ = complete_ && !is_collinear(c);
  if (!complete_) return 0;
  cut_[mesh][triangle] = static_cast<std::uint32_t>(cuts_.size());
  const TriangleFaces& faces = cuts_.emplace_back(nodes_, mesh, surface(mesh).mesh.triangles[triangle], c,
                                                  segments_in(mesh, triangle), budget_);
  for (std::uint32_t h = 0; h < faces.half_edge_count(); ++h) {
    if (faces.left(h) == TriangleFaces::kOutside) continue;
    const std::uint32_t from = faces.start(h), to = faces.start(h ^ 1);
    const std::uint32_t face = first_face_[mesh][triangle] + faces.left(h);
    half_planes_.push_back({std::min(from, to), std::max(from, to), mesh, triangle, face, from < to, faces.side_of(h)});
  }
  return faces.count();
}

std::vector<NodePair> SpaceCells::segments_in(int mesh, std::uint32_t triangle) const {
  const auto &segments = segments_[mesh];
  std::vector<NodePair> within;
  auto segment = std::lower_bound(segments.begin(), segments.end(), std::pair(triangle, NodePair{}));
  for (; segment != segments.end() && segment->first == triangle; ++segment) within.push_back(segment->second);
  return within;
}

// Edges of triangles that do not meet the other surface.
void SpaceCells::join_at_edges(int mesh) {
  const Mesh& m = surface(mesh).mesh;
  const EdgeTable edges(m.vertices.size(), m.triangles);
  std::vector<HalfPlane> here;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    here.clear();
    const auto half_edges = edges.half_edges(e);
    for (const std::uint32_t h : half_edges) {
      if (in_contact(mesh, h / 3)) continue;
      const Triangle& v = m.triangles[h / 3];
      const std::uint32_t from = nodes_.of_vertex(mesh, v[h % 3]), to = nodes_.of_vertex(mesh, v[(h % 3 + 1) % 3]);
      here.push_back({std::min(from, to), std::max(from, to), mesh, h / 3, first_face_[mesh][h / 3], from < to,
                      static_cast<int>(h % 3)});
    }
    if (here.size() == 2 && half_edges.size() == 2) {
      for (const int k : {0, 1}) join(here[k].side_ahead(), here[1 - k].side_behind(), here[k].low, here[k].high);
    } else {
      half_planes_.insert(half_planes_.end(), here.begin(), here.end());
    }
  }
}

void SpaceCells::join_at_stretches() {
  const auto ends = [](const HalfPlane& h) { return NodePair{h.low, h.high}; };
  std::stable_sort(half_planes_.begin(), half_planes_.end(),
                   [&](const HalfPlane& g, const HalfPlane& h) { return ends(g) < ends(h); });
  for (std::size_t i = 0; i < half_planes_.size() && complete_;) {
    std::vector<HalfPlane> here;
    for (const NodePair at = ends(half_planes_[i]); i < half_planes_.size() && ends(half_planes_[i]) == at; ++i) {
      here.push_back(half_planes_[i]);
    }
    spend(budget_, kHalfPlaneWork * here.size());
    const auto groups = here.size() == 2 ? std::optional(std::vector<std::vector<HalfPlane>>{{here[0]}, {here[1]}})
                                         : order_around(a_.mesh, b_.mesh, nodes_, here);
    complete_ = groups && groups->size() > 1;
    for (std::size_t k = 0; complete_ && k < groups->size(); ++k) {
      const auto &group = (*groups)[k], &next = (*groups)[(k + 1) % groups->size()];
      unite_shared(group);
      join(group[0].side_ahead(), next[0].side_behind(), here[0].low, here[0].high);
    }
  }
  half_planes_ = {};
}

void SpaceCells::join(std::uint32_t side, std::uint32_t other, std::uint32_t low, std::uint32_t high) {
  shells_.unite(side, other);
  wedges_.push_back({side, other, low, high});
}

// Half-planes that coincide: a face of each surface.
void SpaceCells::unite_shared(const std::vector<HalfPlane>& half_planes) {
  if (half_planes.size() == 1) return;
  complete_ = complete_ && half_planes.size() == 2 && half_planes[0].mesh != half_planes[1].mesh;
  if (!complete_) return;
  shells_.unite(half_planes[0].side_ahead(), half_planes[1].side_ahead());
  shells_.unite(half_planes[0].side_behind(), half_planes[1].side_behind());
  for (const HalfPlane& h : half_planes) faces_[h.face].shared = true;
}

bool SpaceCells::bounds_nothing(const CellFace& face) const {
  return is_collinear(corners(surface(face.mesh).mesh, face.triangle));
}

ExactPoint SpaceCells::sample(std::uint32_t face) const {
  const CellFace& f = faces_[face];
  const Corners c = corners(surface(f.mesh).mesh, f.triangle);
  if (!in_contact(f.mesh, f.triangle)) return weighted_point(c[0], c[1], c[2], 1.0, 1.0, 1.0);
  return cuts_[cut_[f.mesh][f.triangle]].sample(f.within);
}

std::optional<std::uint32_t> SpaceCells::face_at(int mesh, std::uint32_t triangle, const ExactPoint& p) const {
  const auto within = in_contact(mesh, triangle) ? cuts_[cut_[mesh][triangle]].face_at(p) : 0;
  return within ? std::optional(first_face_[mesh][triangle] + *within) : std::nullopt;
}

template <class Visit>
void SpaceCells::visit_outline(std::uint32_t face, Visit visit) const {
  const CellFace& f = faces_[face];
  if (!in_contact(f.mesh, f.triangle)) {
    const Corners c = corners(surface(f.mesh).mesh, f.triangle);
    for (int i = 0; i < 3; ++i) visit(c[i], c[(i + 1) % 3]);
    return;
  }
  const TriangleFaces& cut = cuts_[cut_[f.mesh][f.triangle]];
  for (std::uint32_t h = 0; h < cut.half_edge_count(); ++h) {
    if (cut.left(h) == f.within) visit(nodes_.at(cut.start(h)).rounded, nodes_.at(cut.start(h ^ 1)).rounded);
  }
}

std::vector<Vec3> SpaceCells::face_corners(std::uint32_t face) const {
  std::vector<Vec3> points;
  visit_outline(face, [&](Vec3 from, Vec3) { points.push_back(from); });
  return points;
}

Aabb SpaceCells::box(std::uint32_t face) const {
  Aabb box;
  visit_outline(face, [&](Vec3 from, Vec3) { box.include(from); });
  return box;
}

Vec3 SpaceCells::area(std::uint32_t face, Vec3 origin) const {
  Vec3 sum;
  visit_outline(face, [&](Vec3 from, Vec3 to) { sum = sum + cross(from - origin, to - origin); });
  return sum * 0.5;
}

}  // namespace satcheck
