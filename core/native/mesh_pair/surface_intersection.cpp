// For every pair of triangles, incidence.hpp names the features that meet: two nodes with a segment between them, or
// the sides of a shared polygon. All triangles around a feature use the same names, so pieces are joined without
// comparing coordinates:
//
// * Coplanar polygons that share a side become one patch. The other sides are its border.
// * Segments that are a side of a patch belong to it. The others join into curves.
// * Collinear triangles are flipped away first, because they hide that an edge ends at a vertex. One that cannot be
//   removed gives points several names, which become one node.
#include "mesh_pair/surface_intersection.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include "base/key_sort.hpp"
#include "base/patches.hpp"
#include "exact/predicates.hpp"
#include "mesh/chains.hpp"
#include "mesh/incidence.hpp"
#include "mesh/slivers.hpp"

namespace satcheck {
namespace {

// Measured steps of two triangles whose boxes meet, of triangles that meet, of two pieces at one side, of the place of a
// point, and of a side of a patch.
constexpr std::uint64_t kTestWork = 200, kMeetingWork = 4000, kPiecesWork = 50, kPointWork = 3000, kSideWork = 300;

bool points_less(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), coordinates_less);
}

// A loop, rotated to start at its least point.
std::vector<Vec3> from_least_point(const std::vector<Vec3>& loop) {
  const Vec3 least = *std::min_element(loop.begin(), loop.end(), coordinates_less);
  std::vector<Vec3> best;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    if (loop[k] != least) continue;
    std::vector<Vec3> turned = loop;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(k), turned.end());
    if (best.empty() || points_less(turned, best)) best = std::move(turned);
  }
  return best;
}

double length_of(const std::vector<Vec3>& points, bool closed) {
  double length = 0;
  for (std::size_t k = 1; k < points.size(); ++k) length += norm(points[k] - points[k - 1]);
  if (closed) length += norm(points.front() - points.back());
  return length;
}

NodePair undirected(NodePair side) {
  return side.first < side.second ? side : NodePair{side.second, side.first};
}

// One polygon that two coplanar triangles share.
struct Piece {
  std::uint32_t triangle_a;
  bool opposed;
  std::vector<NodePair> sides;
};

class Assembly {
 public:
  Assembly(const Mesh& a, const Mesh& b, Budget* budget) : a_(a), b_(b), budget_(budget) {}

  // pair: as it is reported; triangle_a: of the mesh given here.
  void add(ContactPair pair, const TriangleMeeting& meeting, std::uint32_t triangle_a) {
    if (meeting.kind == MeetingKind::none) return;
    spend(budget_, kMeetingWork);
    result_.triangle_pairs.push_back(pair);
    for (const Incidence& node : meeting.nodes) number(node);
    if (meeting.kind == MeetingKind::segment) {
      segments_.emplace_back(number(meeting.nodes[0]), number(meeting.nodes[1]));
    } else if (meeting.kind == MeetingKind::patch) {
      Piece& piece = pieces_.emplace_back(Piece{triangle_a, meeting.opposed, {}});
      for (const MeetingSide& side : meeting.sides) piece.sides.emplace_back(number(side.from), number(side.to));
    } else {
      for (const Incidence& node : meeting.nodes) joined_.emplace_back(number(meeting.nodes[0]), number(node));
    }
  }

  std::size_t pairs() const { return result_.triangle_pairs.size(); }

  SurfaceIntersection finish() {
    merge_names();
    where_.resize(incidences_.size());
    make_patches();
    make_curves();
    make_points();
    sort_all();
    return std::move(result_);
  }

 private:
  std::uint32_t number(const Incidence& node) {
    const auto [known, is_new] = number_.emplace(node, static_cast<std::uint32_t>(incidences_.size()));
    if (is_new) incidences_.push_back(node);
    return known->second;
  }

  void merge_names() {
    DisjointSets sets(incidences_.size());
    for (const auto& [i, k] : joined_) sets.unite(i, k);
    const auto rename = [&](std::vector<NodePair>& pairs) {
      for (auto& [i, k] : pairs) i = sets.find(i), k = sets.find(k);
      std::erase_if(pairs, [](const NodePair& p) { return p.first == p.second; });
    };
    rename(segments_);
    for (Piece& piece : pieces_) rename(piece.sides);
    covered_.resize(incidences_.size());
    for (std::uint32_t i = 0; i < incidences_.size(); ++i) covered_[i] = sets.find(i) != i;
  }

  const ExactPoint& at(std::uint32_t node) {
    if (!where_[node]) {
      spend(budget_, kPointWork);
      where_[node] = locate(incidences_[node], a_, b_);
    }
    return *where_[node];
  }

  // The points of a chain, without those in the middle of a straight line and without repetitions.
  std::vector<Vec3> trace(const std::vector<std::uint32_t>& nodes, bool closed) {
    const std::size_t count = nodes.size();
    std::vector<Vec3> points;
    for (std::size_t k = 0; k < count; ++k) {
      const bool inner = count > 2 && (closed || (k > 0 && k + 1 < count));
      if (inner && straight(at(nodes[(k + count - 1) % count]), at(nodes[k]), at(nodes[(k + 1) % count]))) {
        continue;
      }
      const Vec3 p = at(nodes[k]).rounded;
      if (points.empty() || points.back() != p) points.push_back(p);
    }
    if (closed && points.size() > 1 && points.front() == points.back()) points.pop_back();
    return points;
  }

  bool coplanar(const Piece& p, const Piece& q) const {
    const auto t = corners(a_, p.triangle_a), u = corners(a_, q.triangle_a);
    return p.triangle_a == q.triangle_a ||
           std::all_of(u.begin(), u.end(), [&](Vec3 v) { return orientation(t[0], t[1], t[2], v) == 0; });
  }

  void make_patches() {
    std::map<NodePair, std::vector<std::uint32_t>> users;
    for (std::uint32_t k = 0; k < pieces_.size(); ++k) {
      for (const NodePair& side : pieces_[k].sides) users[side].push_back(k);
    }
    DisjointSets sets(pieces_.size());
    for (const auto& [side, here] : users) {
      border_.push_back(undirected(side));
      covered_[side.first] = covered_[side.second] = true;
      const auto opposite = users.find({side.second, side.first});
      if (side.first > side.second || opposite == users.end()) continue;
      spend(budget_, kPiecesWork * here.size() * opposite->second.size());
      for (const std::uint32_t i : here) {
        for (const std::uint32_t k : opposite->second) {
          const Piece &p = pieces_[i], &q = pieces_[k];
          if (p.opposed == q.opposed && coplanar(p, q)) sets.unite(i, k);
        }
      }
    }
    std::sort(border_.begin(), border_.end());
    std::map<std::uint32_t, std::vector<std::uint32_t>> patches;
    for (std::uint32_t k = 0; k < pieces_.size(); ++k) patches[sets.find(k)].push_back(k);
    for (const auto& [_, members] : patches) add_patch(members);
  }

  void add_patch(const std::vector<std::uint32_t>& members) {
    std::map<NodePair, int> balance;  // of each side from the lower to the higher node
    for (const std::uint32_t k : members) {
      spend(budget_, kSideWork * pieces_[k].sides.size());
      for (const auto& [from, to] : pieces_[k].sides) {
        balance[undirected({from, to})] += from < to ? 1 : -1;
      }
    }
    std::vector<NodePair> border;
    for (const auto& [side, count] : balance) {
      for (int n = 0; n < std::abs(count); ++n) {
        border.push_back(count > 0 ? side : NodePair{side.second, side.first});
      }
    }
    const auto t = corners(a_, pieces_[members[0]].triangle_a);
    const Vec3 normal = rounded_normal(t[0], t[1], t[2]), scaled = normal * (1 / max_abs(normal));
    ContactPatch patch;
    patch.normal = scaled * (1 / norm(scaled));
    patch.opposed = pieces_[members[0]].opposed;
    std::vector<std::pair<double, std::vector<Vec3>>> outlines;  // with signed areas
    for (const auto& loop : join_loops(std::move(border))) {
      std::vector<Vec3> points = trace(loop, true);
      if (points.size() < 3) continue;  // vanished by rounding
      Vec3 sum;
      for (std::size_t k = 2; k < points.size(); ++k) {
        sum = sum + cross(points[k - 1] - points[0], points[k] - points[0]);
      }
      outlines.emplace_back(dot(sum, patch.normal) / 2, from_least_point(points));
    }
    std::sort(outlines.begin(), outlines.end(), [](const auto& x, const auto& y) {
      return x.first != y.first ? x.first > y.first : points_less(x.second, y.second);
    });
    for (auto& [area, points] : outlines) {
      patch.area += area;
      patch.outlines.push_back(std::move(points));
    }
    if (!patch.outlines.empty()) result_.patches.push_back(std::move(patch));
  }

  void make_curves() {
    for (NodePair& s : segments_) s = undirected(s);
    sort_once(segments_);
    std::erase_if(segments_, [&](const NodePair& s) {
      return std::binary_search(border_.begin(), border_.end(), s);
    });
    for (const auto& [i, k] : segments_) covered_[i] = covered_[k] = true;
    for (const Chain& chain : join_chains(segments_, incidences_.size())) {
      ContactCurve curve;
      curve.points = trace(chain.nodes, chain.closed);
      curve.closed = chain.closed && curve.points.size() > 2;
      if (curve.points.size() < 2) {
        result_.points.push_back(curve.points[0]);  // vanished by rounding
        continue;
      }
      std::vector<Vec3> reversed(curve.points.rbegin(), curve.points.rend());
      if (curve.closed) {
        curve.points = from_least_point(curve.points);
        reversed = from_least_point(reversed);
      }
      if (points_less(reversed, curve.points)) curve.points = std::move(reversed);
      curve.length = length_of(curve.points, curve.closed);
      result_.curves.push_back(std::move(curve));
    }
  }

  void make_points() {
    for (std::uint32_t node = 0; node < incidences_.size(); ++node) {
      if (!covered_[node]) result_.points.push_back(at(node).rounded);
    }
  }

  void sort_all() {
    std::sort(result_.points.begin(), result_.points.end(), coordinates_less);
    std::sort(result_.curves.begin(), result_.curves.end(), [](const auto& c, const auto& d) {
      return c.length != d.length ? c.length > d.length : points_less(c.points, d.points);
    });
    std::sort(result_.patches.begin(), result_.patches.end(), [](const auto& p, const auto& q) {
      return p.area != q.area ? p.area > q.area : points_less(p.outlines[0], q.outlines[0]);
    });
    std::vector<ContactPair>& pairs = result_.triangle_pairs;
    std::sort(pairs.begin(), pairs.end(),
              [](ContactPair p, ContactPair q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
    const auto last = std::unique(pairs.begin(), pairs.end(),
                                  [](ContactPair p, ContactPair q) { return p.a == q.a && p.b == q.b; });
    pairs.erase(last, pairs.end());
  }

  const Mesh &a_, &b_;
  Budget* budget_;
  SurfaceIntersection result_;
  std::map<Incidence, std::uint32_t> number_;
  std::vector<Incidence> incidences_;
  std::vector<NodePair> segments_, joined_;
  std::vector<Piece> pieces_;
  std::vector<NodePair> border_;  // sides of all patches, sorted
  std::vector<bool> covered_;     // nodes that are not isolated points
  std::vector<std::optional<ExactPoint>> where_;
};

SurfaceIntersection unlisted(bool within_budget) {
  SurfaceIntersection nothing;
  nothing.complete = false;
  nothing.within_budget = within_budget;
  return nothing;
}

SurfaceIntersection list_all(const Surface& a, const Surface& b, std::size_t max_pairs, Budget* budget) {
  const Sliverless from = without_slivers(a.mesh), to = without_slivers(b.mesh);
  const Mesh &mesh_a = from.mesh, &mesh_b = to.mesh;
  const Bvh rebuilt = to.changed ? build_bvh(mesh_b) : Bvh{};
  const Bvh& bvh = to.changed ? rebuilt : b.bvh;
  Assembly assembly(mesh_a, mesh_b, budget);
  for (std::uint32_t ta = 0; ta < mesh_a.triangles.size(); ++ta) {
    const Aabb box = triangle_box(mesh_a, ta);
    const bool complete = visit_box(bvh, mesh_b, box, [&](std::uint32_t tb) {
      if (meet(box, triangle_box(mesh_b, tb))) {
        spend(budget, kTestWork);
        assembly.add({from.source[ta], to.source[tb]}, meet_triangles(mesh_a, ta, mesh_b, tb), ta);
      }
      return assembly.pairs() <= max_pairs;
    }, budget);
    if (!complete) return unlisted(true);
  }
  return assembly.finish();
}

}  // namespace

SurfaceIntersection surface_intersection(const Surface& a, const Surface& b, std::size_t max_pairs, Budget* budget) {
  try {
    return list_all(a, b, max_pairs, budget);
  } catch (const BudgetSpent&) {
    return unlisted(false);
  }
}

}  // namespace satcheck
