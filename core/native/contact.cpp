// Interiors of two solids overlap when somewhere beside a point of a surface both winding numbers
// differ from 0. When no two triangles cross, that is decided by finitely many points:
//
// * Triangles without contact: each region of them lies on one side of the other surface, so one
//   winding number per region tells.
// * Triangles in contact: what cuts one into pieces are edges of the other mesh that lie in its
//   plane, for anything else would cross it. Each piece lies in the other surface, inside or
//   outside of it as a whole, so one exact sample point per piece tells, with the winding numbers
//   of both meshes on both sides.
// * If no piece of one surface shows an overlap, the interior of the other solid can only be inside
//   the first one as a whole; one sample per region and per contact triangle of it tells.
#include "contact.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "flat_cells.hpp"
#include "mesh_pair.hpp"
#include "patches.hpp"
#include "predicates.hpp"
#include "triangle_pair.hpp"
#include "winding.hpp"

namespace satcheck {
namespace {

// Samples that land on an isolated contact point tell nothing; another one is taken.
constexpr int kSampleAttempts = 8;

// Pieces are visited once per bordering segment piece, and finding those takes time quadratic in the
// cuts: beyond this many pairs of segments in all, pieces are sampled at the centroid only and the
// verdict is not called proven.
constexpr std::size_t kMaxSegmentPairs = 4'000'000;

enum class Sample { overlap, clear, unclear };

struct ContactTriangle {
  std::uint32_t triangle;
  std::vector<std::uint32_t> partners;  // of the other mesh
  std::vector<PlaneSegment> cuts;
};

std::vector<ContactTriangle> group(std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs) {
  std::sort(pairs.begin(), pairs.end());
  std::vector<ContactTriangle> groups;
  for (const auto& [triangle, partner] : pairs) {
    if (groups.empty() || groups.back().triangle != triangle) groups.push_back({triangle, {}, {}});
    groups.back().partners.push_back(partner);
  }
  return groups;
}

// The edges of the partners that lie in the plane of the triangle. Edges between two partners that
// continue each other in the plane cut nothing: the other surface is the same on both sides.
std::vector<PlaneSegment> find_cuts(const Mesh& mesh, const Mesh& other, const ContactTriangle& c) {
  struct Use {
    int flat_up = 0, flat_down = 0, others = 0;
    bool front = false, back = false;  // which way the flat ones face
  };
  const Corners t = corners(mesh, c.triangle);
  const Vec3 normal = rounded_normal(t[0], t[1], t[2]);
  const int axis = projection_axis(normal);
  std::map<std::pair<std::uint32_t, std::uint32_t>, Use> edges;
  for (const std::uint32_t partner : c.partners) {
    const Triangle& corner = other.triangles[partner];
    const Corners p = corners(other, partner);
    bool in_plane[3];
    for (int i = 0; i < 3; ++i) in_plane[i] = orientation(t[0], t[1], t[2], p[i]) == 0;
    const int turn = in_plane[0] && in_plane[1] && in_plane[2] ? orientation_2d(p[0], p[1], p[2], axis) : 0;
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 1) % 3;
      if (!in_plane[i] || !in_plane[k] || corner[i] == corner[k]) continue;
      Use& use = edges[std::minmax(corner[i], corner[k])];
      if (turn == 0) {
        ++use.others;
      } else {
        ++(corner[i] < corner[k] ? use.flat_up : use.flat_down);
        (turn > 0 ? use.front : use.back) = true;
      }
    }
  }
  std::vector<PlaneSegment> cuts;
  for (const auto& [edge, use] : edges) {
    const bool continues = use.flat_up == 1 && use.flat_down == 1 && use.others == 0 && use.front != use.back;
    if (!continues) cuts.push_back({other.vertices[edge.first], other.vertices[edge.second]});
  }
  return cuts;
}

// One surface in contact, seen against the other one, which is solid.
class Side {
 public:
  Side(const Surface& self, const Surface& other, std::vector<ContactTriangle> contacts)
      : self_(self), other_(other), contacts_(std::move(contacts)) {}

  // A point of a triangle without contact that is inside the other solid.
  std::optional<Overlap> free_region_inside() const {
    const Mesh& mesh = self_.mesh;
    std::vector<bool> in_contact(mesh.triangles.size(), false);
    for (const ContactTriangle& c : contacts_) in_contact[c.triangle] = true;
    DisjointSets sets(mesh.vertices.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (in_contact[t]) continue;
      sets.unite(mesh.triangles[t][0], mesh.triangles[t][1]);
      sets.unite(mesh.triangles[t][0], mesh.triangles[t][2]);
    }
    std::vector<bool> asked(mesh.vertices.size(), false);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (in_contact[t]) continue;
      const std::uint32_t region = sets.find(mesh.triangles[t][0]);
      if (asked[region]) continue;
      asked[region] = true;
      const Vec3 point = mesh.vertices[mesh.triangles[t][0]];
      if (winding_number(other_, point).value_or(0) != 0) return Overlap{t, kNoTriangle, point};
    }
    return std::nullopt;
  }

  std::size_t prepare_cuts() {
    std::size_t segment_pairs = 0;
    for (ContactTriangle& c : contacts_) {
      const Corners t = corners(self_.mesh, c.triangle);
      if (collinear(t[0], t[1], t[2])) continue;
      c.cuts = find_cuts(self_.mesh, other_.mesh, c);
      segment_pairs += (3 + c.cuts.size()) * (3 + c.cuts.size());
    }
    return segment_pairs;
  }

  // Samples every piece of every contact triangle, or only the middle of each.
  ContactVerdict sample(bool every_piece) const {
    ContactVerdict verdict;
    for (const ContactTriangle& c : contacts_) {
      const Corners t = corners(self_.mesh, c.triangle);
      if (collinear(t[0], t[1], t[2])) continue;
      visit_pieces(t, every_piece ? c.cuts : std::vector<PlaneSegment>{}, [&](const PieceSampler& at) {
        Sample result = Sample::unclear;
        for (int k = 0; k < kSampleAttempts && result == Sample::unclear; ++k) {
          const ExactPoint point = at(k);
          result = judge(t, point, every_piece);
          if (result == Sample::overlap) {
            verdict.overlap = Overlap{c.triangle, c.partners[0], point.rounded};
          }
        }
        if (result == Sample::unclear) verdict.proven = false;
        return !verdict.overlap.has_value();
      });
      if (verdict.overlap) return {verdict.overlap, true};
    }
    return verdict;
  }

 private:
  Sample judge(const Corners& t, const ExactPoint& p, bool must_be_generic) const {
    const auto beside = [&](const Surface& s, int side) {
      return winding_beside(s.mesh, s.bvh, p, t[0], t[1], t[2], side);
    };
    const std::optional<int> inside = winding_number(other_.mesh, other_.bvh, p);
    if (inside == 0) return Sample::clear;
    if (!self_.solid) return inside ? Sample::overlap : Sample::clear;
    bool unclear = !inside && must_be_generic && meets_another_plane(t, p);
    for (const int side : {1, -1}) {
      const std::optional<int> mine = beside(self_, side);
      if (mine == 0) continue;
      const std::optional<int> theirs = inside ? inside : beside(other_, side);
      if (!mine || !theirs) unclear = true;
      if (mine && theirs && *theirs != 0) return Sample::overlap;
    }
    return unclear ? Sample::unclear : Sample::clear;
  }

  // Does the point lie on a triangle of the other mesh that is not in the plane of t?
  bool meets_another_plane(const Corners& t, const ExactPoint& p) const {
    return !visit_box(other_.bvh, point_box(p), [&](std::uint32_t u) {
      const Corners c = corners(other_.mesh, u);
      const bool same_plane = std::all_of(c.begin(), c.end(), [&](Vec3 v) {
        return orientation(t[0], t[1], t[2], v) == 0;
      });
      return same_plane || !point_in_triangle(p, c[0], c[1], c[2]);
    });
  }

  const Surface& self_;
  const Surface& other_;
  std::vector<ContactTriangle> contacts_;
};

ContactVerdict swapped(ContactVerdict verdict) {
  if (verdict.overlap) std::swap(verdict.overlap->triangle_a, verdict.overlap->triangle_b);
  return verdict;
}

}  // namespace

ContactVerdict judge_contact(const Surface& a, const Surface& b,
                             const std::vector<ContactPair>& contacts) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> from_a, from_b;
  for (const ContactPair& c : contacts) {
    from_a.emplace_back(c.a, c.b);
    from_b.emplace_back(c.b, c.a);
  }
  Side side_a(a, b, group(std::move(from_a))), side_b(b, a, group(std::move(from_b)));
  if (b.solid) {
    if (const auto overlap = side_a.free_region_inside()) return {overlap, true};
  }
  if (a.solid) {
    if (const auto overlap = side_b.free_region_inside()) return swapped({overlap, true});
  }
  const std::size_t work_a = side_a.prepare_cuts(), work_b = side_b.prepare_cuts();
  const bool a_first = !a.solid || (b.solid && work_a <= work_b);
  const bool affordable = (a_first ? work_a : work_b) <= kMaxSegmentPairs;
  ContactVerdict first = a_first ? side_a.sample(affordable) : swapped(side_b.sample(affordable));
  first.proven = first.overlap.has_value() || (first.proven && affordable);
  if (first.overlap || !a.solid || !b.solid) return first;
  ContactVerdict second = a_first ? swapped(side_b.sample(false)) : side_a.sample(false);
  if (second.overlap) return second;
  return {std::nullopt, first.proven && second.proven};
}

}  // namespace satcheck
