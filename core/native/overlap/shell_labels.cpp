#include "overlap/shell_labels.hpp"

#include <algorithm>

#include "exact/dyadic.hpp"
#include "mesh/winding.hpp"

namespace satcheck {
namespace {

struct Hit {
  Ratio at;
  std::uint32_t near_side, far_side;
};

// Adds the hits of one surface on the segment from p to `far`. False: the segment meets an edge, or a line along which the
// surfaces meet.
bool add_hits(const SpaceCells& cells, int mesh, const ExactPoint& p, Vec3 far, std::vector<Hit>& hits) {
  const Surface& surface = cells.surface(mesh);
  const ExactPoint end = make_exact_point(far);
  bool clear = true;
  const auto all = [&](std::uint32_t) { return clear; };
  const bool crosses = visit_crossings(surface.mesh, surface.bvh, p, far, all, [&](std::uint32_t t, int crossing) {
    const Corners c = corners(surface.mesh, t);
    Ratio at = zero_between(orientation_value(c[0], c[1], c[2], p), orientation_value(c[0], c[1], c[2], far) * p.w);
    const auto face = cells.face_at(mesh, t, between(p, end, at.denominator - at.numerator, at.numerator));
    clear = face.has_value();
    if (!clear) return;
    const bool to_front = crossing > 0;
    hits.push_back({std::move(at), 2 * *face + (to_front ? 1 : 0), 2 * *face + (to_front ? 0 : 1)});
  }, cells.budget());
  return crosses && clear;
}

}  // namespace

ShellLabels::ShellLabels(SpaceCells& cells) : cells_(cells) {
  const auto box_of = [&](int mesh) { return cells.surface(mesh).bvh.nodes[0].box; };
  const auto face_count = static_cast<std::uint32_t>(cells.faces().size());
  // Triangles that are not cut come first, because they are faster.
  for (const bool is_cut : {false, true}) {
    for (std::uint32_t f = 0; f < face_count; ++f) {
      const CellFace& face = cells.faces()[f];
      if (cells.in_contact(face.mesh, face.triangle) != is_cut || known(f) || cells.bounds_nothing(face)) continue;
      const Corners c = corners(cells.surface(face.mesh).mesh, face.triangle);
      if (!meet(triangle_box(cells.surface(face.mesh).mesh, face.triangle), box_of(1 - face.mesh))) continue;
      if (is_cut) {
        complete_ = note(f, cells.sample(f)) && complete_;
      } else {
        complete_ = note(f, lazy_centroid(c)) && complete_;
      }
    }
  }
}

template <class Point>
bool ShellLabels::note(std::uint32_t face, const Point& p) {
  const CellFace& f = cells_.faces()[face];
  const Surface &own = cells_.surface(f.mesh), &other = cells_.surface(1 - f.mesh);
  const Corners c = corners(own.mesh, f.triangle);
  const auto mine = winding_beside(own.mesh, own.bvh, p, c[0], c[1], c[2], f.triangle, cells_.budget());
  const auto theirs = winding_beside(other.mesh, other.bvh, p, c[0], c[1], c[2], {}, cells_.budget());
  if (!mine || !theirs) return false;
  for (const int behind : {0, 1}) {
    const int m = behind ? mine->back : mine->front, t = behind ? theirs->back : theirs->front;
    of_shell_.emplace(cells_.shell(2 * face + behind), f.mesh == 0 ? Windings{m, t} : Windings{t, m});
  }
  return true;
}

std::optional<Windings> ShellLabels::of(std::uint32_t side) const {
  const auto known = of_shell_.find(cells_.shell(side));
  return known == of_shell_.end() ? std::nullopt : std::optional(known->second);
}

std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> sides_on_way(const SpaceCells& cells,
                                                                                 std::uint32_t side) {
  const CellFace& face = cells.faces()[side / 2];
  const Corners c = corners(cells.surface(face.mesh).mesh, face.triangle);
  const ExactPoint p = cells.sample(side / 2);
  Aabb bounds = cells.surface(0).bvh.nodes[0].box;
  bounds.include(cells.surface(1).bvh.nodes[0].box);
  const Heading first = nearest_wall(bounds, p.rounded);
  for (int attempt = 0; attempt < kMaxSegments; ++attempt) {
    const Vec3 far = outside_point(bounds, p.rounded, first, attempt);
    if (orientation(c[0], c[1], c[2], far) != (side % 2 == 0 ? 1 : -1)) continue;
    std::vector<Hit> hits;
    if (!add_hits(cells, 0, p, far, hits) || !add_hits(cells, 1, p, far, hits)) continue;
    std::stable_sort(hits.begin(), hits.end(), [](const Hit& g, const Hit& h) { return less(g.at, h.at); });
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    const Hit* last = nullptr;
    for (const Hit& hit : hits) {
      if (last && !less(last->at, hit.at)) continue;  // faces that coincide
      pairs.emplace_back(last ? last->far_side : side, hit.near_side);
      last = &hit;
    }
    return pairs;
  }
  return std::nullopt;
}

}  // namespace satcheck
