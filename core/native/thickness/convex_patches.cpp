// Method: common edges of triangles in one plane are removed, longest first, as long as both of their ends stay convex:
// Stefan Hertel, Kurt Mehlhorn, "Fast Triangulation of the Plane with Respect to Simple Polygons" (1985).
#include "thickness/convex_patches.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/edge_table.hpp"
#include "base/patches.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// The cost of a distance grows with the corners of a patch.
constexpr std::size_t kMostCorners = 16;

struct Seam {
  double length_squared;
  std::uint32_t from, to;      // as the first triangle runs it
  std::uint32_t first, second;  // places in the list
};

// The boxes of more patches would be a third of the memory of a search.
constexpr std::size_t kMostBoxes = 65536;

class Merging {
 public:
  Merging(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, double flatness)
      : mesh_(mesh), triangles_(triangles), flatness_(flatness), sets_(triangles.size()), merged_(triangles.size()), normals_(triangles.size()) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto c = corners(mesh, triangles[i]);
      const Vec3 normal = rounded_normal(c[0], c[1], c[2]);
      const double length = norm(normal);
      if (length > 0) normals_[i] = normal * (1 / length);
    }
  }

  ConvexPatches run() {
    for (const Seam& seam : flat_seams()) merge(seam);
    ConvexPatches result;
    result.patch_of.assign(mesh_.triangles.size(), kNoIndex);
    std::vector<std::uint32_t> sizes(triangles_.size(), 0);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) ++sizes[sets_.find(i)];
    std::size_t corners = 0;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) corners += sizes[i] == 0 ? 0 : outline(i).size();
    result.patches.reserve(triangles_.size() - static_cast<std::size_t>(std::count(sizes.begin(), sizes.end(), 0u)));
    result.outlines.reserve(corners);
    std::uint32_t first = 0;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (sizes[i] == 0) continue;
      result.patch_of[triangles_[i]] = static_cast<std::uint32_t>(result.patches.size());
      append(result, i, first, sizes[i]);
      first += sizes[i];
    }
    list_triangles(result);
    if (result.patches.size() <= kMostBoxes) {
      for (const Patch& patch : result.patches) result.boxes.push_back(result.box_of(patch));
    }
    return result;
  }

 private:
  using Outline = std::span<const std::uint32_t>;

  // Vertices, of a set at its representative.
  Outline outline(std::uint32_t i) const {
    const auto [first, count] = merged_[i];
    return count == 0 ? Outline(mesh_.triangles[triangles_[i]]) : Outline(corners_).subspan(first, count);
  }

  std::vector<Seam> flat_seams() const {
    std::vector<Triangle> faces;
    faces.reserve(triangles_.size());
    for (const std::uint32_t t : triangles_) faces.push_back(mesh_.triangles[t]);
    const EdgeTable edges(mesh_.vertices.size(), faces);
    std::vector<Seam> seams;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto h = edges.half_edges(e);
      if (h.size() == 2 && edges.ascends(h[0]) != edges.ascends(h[1])) add_seam(seams, h[0], h[1]);
    }
    std::sort(seams.begin(), seams.end(), [](const Seam& a, const Seam& b) {
      if (a.length_squared != b.length_squared) return a.length_squared > b.length_squared;
      return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
    return seams;
  }

  // The half-edges run against each other.
  void add_seam(std::vector<Seam>& seams, std::uint32_t half_edge, std::uint32_t other) const {
    const std::uint32_t a = half_edge / 3, b = other / 3;
    if (!(dot(normals_[a], normals_[b]) > 0)) return;
    if (deviation(a, outline(b)) > flatness_ || deviation(b, outline(a)) > flatness_) return;
    const std::uint32_t from = outline(a)[half_edge % 3], to = outline(a)[(half_edge % 3 + 1) % 3];
    seams.push_back({norm_squared(mesh_.vertices[from] - mesh_.vertices[to]), from, to, a, b});
  }

  // From the plane of a triangle.
  double deviation(std::uint32_t plane, Outline outline) const {
    const Vec3 origin = mesh_.vertices[mesh_.triangles[triangles_[plane]][0]];
    double most = 0;
    for (const std::uint32_t v : outline) {
      most = larger(most, std::fabs(dot(normals_[plane], mesh_.vertices[v] - origin)));
    }
    return most;
  }

  void merge(const Seam& seam) {
    const std::uint32_t p = sets_.find(seam.first), q = sets_.find(seam.second);
    if (p == q) return;
    const std::uint32_t kept = std::min(p, q);
    join(outline(p), outline(q), seam);
    if (joined_.empty() || deviation(kept, joined_) > flatness_) return;
    if (!is_convex_at(joined_, kept, seam.from) || !is_convex_at(joined_, kept, seam.to)) return;
    sets_.unite(p, q);
    merged_[kept] = {static_cast<std::uint32_t>(corners_.size()), static_cast<std::uint32_t>(joined_.size())};
    corners_.insert(corners_.end(), joined_.begin(), joined_.end());
  }

  // The outline of both; empty where they share more than the seam, or have too many corners.
  void join(Outline p, Outline q, const Seam& seam) {
    joined_.clear();
    if (p.size() + q.size() > kMostCorners + 2) return;
    for (const std::uint32_t v : q) {
      if (v != seam.from && v != seam.to && std::find(p.begin(), p.end(), v) != p.end()) return;
    }
    // p runs from -> to, q runs to -> from.
    const auto walk = [&](Outline loop, std::uint32_t start, std::uint32_t end) {
      auto at = static_cast<std::size_t>(std::find(loop.begin(), loop.end(), start) - loop.begin());
      for (; loop[at % loop.size()] != end; ++at) joined_.push_back(loop[at % loop.size()]);
    };
    walk(p, seam.to, seam.from);
    walk(q, seam.from, seam.to);
  }

  bool is_convex_at(Outline outline, std::uint32_t plane, std::uint32_t vertex) const {
    const std::size_t n = outline.size();
    const auto at = static_cast<std::size_t>(std::find(outline.begin(), outline.end(), vertex) - outline.begin());
    const auto point = [&](std::size_t i) { return mesh_.vertices[outline[i % n]]; };
    const int axis = projection_axis(normals_[plane]);
    return orientation_2d(point(at + n - 1), point(at), point(at + 1), axis) * (normals_[plane][axis] > 0 ? 1 : -1) >= 0;
  }

  // A patch of the set with this representative; its triangles are listed later.
  void append(ConvexPatches& result, std::uint32_t i, std::uint32_t first_triangle, std::uint32_t triangle_count) const {
    const Outline vertices = outline(i);
    Patch patch{normals_[i], static_cast<std::uint32_t>(result.outlines.size()),
                static_cast<std::uint32_t>(vertices.size()), first_triangle, triangle_count, 0};
    for (const std::uint32_t v : vertices) result.outlines.push_back(mesh_.vertices[v]);
    patch.slack = triangle_count > 1 ? 2 * deviation(i, vertices) : 0;
    result.patches.push_back(patch);
  }

  void list_triangles(ConvexPatches& result) {
    result.triangles.resize(triangles_.size());
    std::vector<std::uint32_t> next;
    for (const Patch& patch : result.patches) next.push_back(patch.first_triangle);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      const std::uint32_t patch = result.patch_of[triangles_[sets_.find(i)]];
      result.patch_of[triangles_[i]] = patch;
      result.triangles[next[patch]++] = triangles_[i];
    }
  }

  const Mesh& mesh_;
  const std::vector<std::uint32_t>& triangles_;
  double flatness_;
  DisjointSets sets_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> merged_;  // of sets of several triangles, at their representatives: first and count in corners_
  std::vector<std::uint32_t> corners_, joined_;
  std::vector<Vec3> normals_;                       // of each triangle
};

}  // namespace

Aabb ConvexPatches::box_of(const Patch& patch) const {
  Aabb box;
  for (std::uint32_t i = patch.first; i < patch.first + patch.count; ++i) box.include(outlines[i]);
  return box.widened(patch.slack);
}

Vec3 ConvexPatches::nearest(const Patch& patch, Vec3 p) const {
  const std::span<const Vec3> outline{outlines.data() + patch.first, patch.count};
  const auto edge = [&](std::size_t i) { return outline[i + 1 < outline.size() ? i + 1 : 0] - outline[i]; };
  bool beside = norm_squared(patch.normal) == 0;
  for (std::size_t i = 0; i < outline.size() && !beside; ++i) beside = dot(cross(patch.normal, edge(i)), p - outline[i]) < 0;
  if (!beside) return p - patch.normal * dot(patch.normal, p - origin(patch));
  // All edges, not only those that p is beyond: of two almost on one line, rounding may choose the far one.
  Vec3 best;
  double least = INFINITY;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3 e = edge(i), w = p - outline[i];
    const double length_squared = norm_squared(e), along = dot(w, e);
    const double t = along <= 0 || !(length_squared > 0) ? 0 : along >= length_squared ? 1 : along / length_squared;
    const Vec3 q = outline[i] + e * t;
    const double d = norm_squared(q - p);
    if (d < least) {
      least = d;
      best = q;
    }
  }
  return best;
}

ConvexPatches convex_patches(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, double flatness) {
  return Merging(mesh, triangles, flatness).run();
}

}  // namespace satcheck
