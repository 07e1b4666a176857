// Method: common edges of triangles in one plane are removed, longest first, as long as both of their ends stay convex:
// Stefan Hertel, Kurt Mehlhorn, "Fast Triangulation of the Plane with Respect to Simple Polygons" (1985).
#include "thickness/convex_patches.hpp"

#include <algorithm>
#include <cmath>

#include "base/patches.hpp"
#include "exact/point_in_triangle.hpp"
#include "exact/predicates.hpp"

namespace satcheck {
namespace {

// The cost of a distance grows with the corners of a patch.
constexpr std::size_t kMostCorners = 16;

struct Edge {
  std::uint32_t low, high;  // vertices
  std::uint32_t triangle;   // place in the list
  bool upward;              // runs from low to high
};

struct Seam {
  double length_squared;
  std::uint32_t from, to;      // as the first triangle runs it
  std::uint32_t first, second;  // places in the list
};

class Merging {
 public:
  Merging(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, double flatness)
      : mesh_(mesh), triangles_(triangles), flatness_(flatness), sets_(triangles.size()), outlines_(triangles.size()),
        normals_(triangles.size()) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Triangle& t = mesh.triangles[triangles[i]];
      outlines_[i] = {t[0], t[1], t[2]};
      const auto c = corners(mesh, triangles[i]);
      const Vec3 normal = rounded_normal(c[0], c[1], c[2]);
      const double length = norm(normal);
      if (length > 0) normals_[i] = normal * (1 / length);
    }
  }

  ConvexPatches run() {
    for (const Seam& seam : flat_seams()) merge(seam);
    ConvexPatches result;
    result.patch_of.assign(mesh_.triangles.size(), kNoPatch);
    std::vector<std::vector<std::uint32_t>> members(triangles_.size());
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) members[sets_.find(i)].push_back(triangles_[i]);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (sets_.find(i) == i) append(result, i, members[i]);
    }
    return result;
  }

 private:
  std::vector<Seam> flat_seams() const {
    std::vector<Edge> edges;
    edges.reserve(3 * triangles_.size());
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      const auto& t = outlines_[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        edges.push_back({std::min(from, to), std::max(from, to), i, from < to});
      }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
      return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
    });
    std::vector<Seam> seams;
    for (std::size_t i = 0; i < edges.size();) {
      std::size_t end = i + 1;
      while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
      if (end == i + 2 && edges[i].upward != edges[i + 1].upward) add_seam(seams, edges[i], edges[i + 1]);
      i = end;
    }
    std::sort(seams.begin(), seams.end(), [](const Seam& a, const Seam& b) {
      if (a.length_squared != b.length_squared) return a.length_squared > b.length_squared;
      return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
    return seams;
  }

  void add_seam(std::vector<Seam>& seams, const Edge& a, const Edge& b) const {
    if (!(dot(normals_[a.triangle], normals_[b.triangle]) > 0)) return;
    if (deviation(a.triangle, outlines_[b.triangle]) > flatness_) return;
    if (deviation(b.triangle, outlines_[a.triangle]) > flatness_) return;
    const std::uint32_t from = a.upward ? a.low : a.high, to = a.upward ? a.high : a.low;
    seams.push_back({norm_squared(mesh_.vertices[from] - mesh_.vertices[to]), from, to, a.triangle, b.triangle});
  }

  // From the plane of a triangle.
  double deviation(std::uint32_t plane, const std::vector<std::uint32_t>& outline) const {
    const Vec3 origin = mesh_.vertices[mesh_.triangles[triangles_[plane]][0]];
    double most = 0;
    for (const std::uint32_t v : outline) {
      most = std::fmax(most, std::fabs(dot(normals_[plane], mesh_.vertices[v] - origin)));
    }
    return most;
  }

  void merge(const Seam& seam) {
    const std::uint32_t p = sets_.find(seam.first), q = sets_.find(seam.second);
    if (p == q) return;
    const std::uint32_t kept = std::min(p, q);
    std::vector<std::uint32_t> joined = joined_outline(outlines_[p], outlines_[q], seam);
    if (joined.empty() || deviation(kept, joined) > flatness_) return;
    if (!is_convex_at(joined, kept, seam.from) || !is_convex_at(joined, kept, seam.to)) return;
    sets_.unite(p, q);
    outlines_[kept] = std::move(joined);
    outlines_[std::max(p, q)].clear();
  }

  // Empty where they share more than the seam, or have too many corners.
  static std::vector<std::uint32_t> joined_outline(const std::vector<std::uint32_t>& p, const std::vector<std::uint32_t>& q,
                                                   const Seam& seam) {
    if (p.size() + q.size() > kMostCorners + 2) return {};
    for (const std::uint32_t v : q) {
      if (v != seam.from && v != seam.to && std::find(p.begin(), p.end(), v) != p.end()) return {};
    }
    // p runs from -> to, q runs to -> from.
    std::vector<std::uint32_t> joined;
    const auto walk = [&](const std::vector<std::uint32_t>& loop, std::uint32_t start, std::uint32_t end) {
      auto at = static_cast<std::size_t>(std::find(loop.begin(), loop.end(), start) - loop.begin());
      for (; loop[at % loop.size()] != end; ++at) joined.push_back(loop[at % loop.size()]);
    };
    walk(p, seam.to, seam.from);
    walk(q, seam.from, seam.to);
    return joined;
  }

  bool is_convex_at(const std::vector<std::uint32_t>& outline, std::uint32_t plane, std::uint32_t vertex) const {
    const std::size_t n = outline.size();
    const auto at = static_cast<std::size_t>(std::find(outline.begin(), outline.end(), vertex) - outline.begin());
    const auto point = [&](std::size_t i) { return mesh_.vertices[outline[i % n]]; };
    const int axis = projection_axis(normals_[plane]);
    return orientation_2d(point(at + n - 1), point(at), point(at + 1), axis) * (normals_[plane][axis] > 0 ? 1 : -1) >= 0;
  }

  void append(ConvexPatches& result, std::uint32_t i, const std::vector<std::uint32_t>& members) const {
    Patch patch{normals_[i], mesh_.vertices[outlines_[i][0]], static_cast<std::uint32_t>(result.outlines.size()),
                static_cast<std::uint32_t>(outlines_[i].size()), static_cast<std::uint32_t>(result.triangles.size()),
                static_cast<std::uint32_t>(members.size()), 0};
    Aabb& box = result.boxes.emplace_back();
    for (const std::uint32_t v : outlines_[i]) {
      result.outlines.push_back(mesh_.vertices[v]);
      box.include(mesh_.vertices[v]);
    }
    patch.slack = members.size() > 1 ? 2 * deviation(i, outlines_[i]) : 0;
    const Vec3 bulge{patch.slack, patch.slack, patch.slack};
    box = {box.min - bulge, box.max + bulge};
    for (const std::uint32_t t : members) result.patch_of[t] = static_cast<std::uint32_t>(result.patches.size());
    result.triangles.insert(result.triangles.end(), members.begin(), members.end());
    result.patches.push_back(patch);
  }

  const Mesh& mesh_;
  const std::vector<std::uint32_t>& triangles_;
  double flatness_;
  DisjointSets sets_;
  std::vector<std::vector<std::uint32_t>> outlines_;  // of each set, at its representative
  std::vector<Vec3> normals_;                         // of each triangle
};

}  // namespace

Vec3 ConvexPatches::nearest(const Patch& patch, Vec3 p) const {
  const Vec3* outline = outlines.data() + patch.first;
  const bool flat = norm_squared(patch.normal) == 0;
  Vec3 best;
  double least = INFINITY;
  for (std::uint32_t i = 0; i < patch.count; ++i) {
    const Vec3 a = outline[i], edge = outline[i + 1 < patch.count ? i + 1 : 0] - a, w = p - a;
    if (!flat && dot(cross(patch.normal, edge), w) >= 0) continue;
    const double length_squared = norm_squared(edge), along = dot(w, edge);
    const double t = along <= 0 || !(length_squared > 0) ? 0 : along >= length_squared ? 1 : along / length_squared;
    const Vec3 q = a + edge * t;
    const double d = norm_squared(q - p);
    if (d < least) {
      least = d;
      best = q;
    }
  }
  return least < INFINITY ? best : p - patch.normal * dot(patch.normal, p - patch.origin);
}

ConvexPatches convex_patches(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, double flatness) {
  return Merging(mesh, triangles, flatness).run();
}

}  // namespace satcheck
