// The closed surface of triangles that EPA grows inside A - B, on support points.
//
// Faces are stored in blocks of four, one for each lane, so that planes are computed and compared four at a time. New
// faces start a new block, because a read with the width of the last write does not stall.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/rounding.hpp"
#include "convex/simplex.hpp"

namespace satcheck {

// An edge of a face: 16 * block + 4 * corner that it starts from (0, 1, 2) + lane. A face is identified by its first
// edge.
using HalfEdge = std::uint32_t;

struct FaceBlock {
  // The plane of a face: unit outward normal, and signed distance from the origin, positive if the origin lies inside.
  // A lane with distance INFINITY has no face.
  double normal_x[4], normal_y[4], normal_z[4], distance[4];
  double stretch_squared[4];  // (product of the two shortest edges / twice the area)^2: factor of a normal's error
  // By the last four bits of an edge: its start vertex, and its opposite half-edge.
  std::uint32_t vertex[12];
  HalfEdge twin[12];
};

class ExpandingPolytope {
 public:
  // The polytope of the calling thread. Not inlined, because a loop would otherwise look up the thread-local address
  // again and again.
  SATCHECK_NOINLINE static ExpandingPolytope& of_thread();

  // Prepares for the next query and keeps the buffers.
  void clear(const MinkowskiDifference& difference) {
    visible_noise_ = kVisible * difference.scale;
    thin_ = kFlat * difference.scale;
    support_error_ = difference.support_error();
    blocks_used_ = 0;
    vertices_used_ = 0;
    known_ = 0;
    free_count_ = 0;
  }

  // False: the tetrahedron is flat up to rounding.
  SATCHECK_INLINE bool start(const Simplex& tetrahedron);

  SATCHECK_INLINE HalfEdge closest_face() const;

  // Adds a point that sees `face`. False: the polytope cannot be expanded and is broken.
  SATCHECK_INLINE bool expand(const SupportPoint& point, HalfEdge face);

  // A lower bound of the signed penetration. If all oriented planes of a closed surface pass the origin at more than r,
  // the surface winds around the origin, and the hull of its vertices contains the ball of radius r. This holds even if
  // rounding has made the surface non-convex. Vertices have at most a support error. The error of a plane is that of a
  // cross product of computed edges (6 roundoffs times their lengths), divided by its length, at a lever of sqrt(3)
  // scales. `closest` is tried first, because few other faces come near it.
  SATCHECK_INLINE double least_proven_distance(HalfEdge closest) const;

  double distance(HalfEdge face) const { return blocks_[face / 16].distance[face % 4]; }
  Vec3 normal(HalfEdge face) const { return normal_in(blocks_[face / 16], face); }
  const SupportPoint& vertex(HalfEdge face, int corner) const {
    return vertices_[blocks_[face / 16].vertex[4 * corner + face % 4]];
  }
  bool has_vertex(HalfEdge face, const SupportPoint& point) const {
    return vertex(face, 0).same_as(point) || vertex(face, 1).same_as(point) || vertex(face, 2).same_as(point);
  }
  bool contains(const SupportPoint& point) const {
    if ((known_ & mark_of(point)) == 0) return false;
    const auto end = vertices_.begin() + static_cast<std::ptrdiff_t>(vertices_used_);
    return std::any_of(vertices_.begin(), end, [&](const SupportPoint& v) { return v.same_as(point); });
  }

 private:
  struct FourPoints {
    Lanes x, y, z;
  };

  static Vec3 normal_in(const FaceBlock& b, HalfEdge h) {
    return {b.normal_x[h % 4], b.normal_y[h % 4], b.normal_z[h % 4]};
  }
  static HalfEdge next(HalfEdge h) { return h % 16 < 8 ? h + 4 : h - 8; }  // around the face

  static void empty(FaceBlock& b) { store_lanes(b.distance, all_lanes(INFINITY)); }

  // The first edge of an empty block. The block after the last one is empty too.
  HalfEdge take_block() {
    if (free_count_ > 0) return free_[--free_count_];
    empty(blocks_[blocks_used_ + 1]);
    return 16 * blocks_used_++;
  }

  // One bit of 64. If the bit of a point is not set, the point is new.
  static std::uint64_t mark_of(const SupportPoint& p) { return std::uint64_t{1} << ((7 * p.index_a + p.index_b) % 64); }
  std::uint32_t add_vertex(const SupportPoint& point) {
    vertices_[vertices_used_] = point;
    known_ |= mark_of(point);
    return vertices_used_++;
  }

  // Reserves memory for one vertex, and for a fan around all faces.
  void make_room() {
    if (std::max(2 * blocks_used_ + 2, vertices_used_ + 4) > room_) grow();
  }
  SATCHECK_NOINLINE void grow();

  SATCHECK_INLINE FourPoints gather(const std::uint32_t* index) const {
    const Vec3 &a = vertices_[index[0]].w, &b = vertices_[index[1]].w, &c = vertices_[index[2]].w, &d = vertices_[index[3]].w;
    return {Lanes{a.x, b.x, c.x, d.x}, Lanes{a.y, b.y, c.y, d.y}, Lanes{a.z, b.z, c.z, d.z}};
  }
  SATCHECK_INLINE std::uint32_t take_visible(Vec3 point, HalfEdge face);
  SATCHECK_INLINE bool add_fan(std::uint32_t apex, std::uint32_t count);
  // Sets the planes of a block's first `faces` faces. False: a face is thinner than noise.
  SATCHECK_INLINE bool set_planes(FaceBlock& b, const FourPoints& tail, const FourPoints& head, const FourPoints& apex,
                                  std::size_t faces) const;

  double visible_noise_ = 0, thin_ = 0, support_error_ = 0;
  std::uint32_t blocks_used_ = 0, free_count_ = 0, vertices_used_ = 0, room_ = 0;
  std::uint64_t known_ = 0;  // the marks of the vertices
  std::vector<FaceBlock> blocks_;
  std::vector<std::uint32_t> faces_in_;  // number of faces of each block
  std::vector<HalfEdge> free_;           // the first edges of blocks without a face
  std::vector<SupportPoint> vertices_;
  std::vector<HalfEdge> horizon_;     // edges around the visible faces, as half-edges of hidden faces
  std::vector<std::uint32_t> tails_;  // their end vertices
  std::vector<HalfEdge> fan_;         // the first edges of its blocks
  std::vector<HalfEdge> pending_;     // edges that the walk has still to visit
};

SATCHECK_INLINE HalfEdge ExpandingPolytope::closest_face() const {
  const FaceBlock* blocks = blocks_.data();
  const Lanes first = {0, 1, 2, 3};
  LaneBest even = {-load_lanes(blocks[0].distance), first}, odd = even;
  Lanes at = first + all_lanes(16);
  for (std::size_t i = 1; i < blocks_used_; i += 2) {  // two chains: a block depends on the block before the last
    const Lanes value0 = -load_lanes(blocks[i + 1].distance), value1 = -load_lanes(blocks[i].distance);
    const LaneMask closer0 = value0 > even.value, closer1 = value1 > odd.value;
    even = {select(closer0, value0, even.value), select(closer0, at + all_lanes(16), even.index)};
    odd = {select(closer1, value1, odd.value), select(closer1, at, odd.index)};
    at = at + all_lanes(32);
  }
  return index_of_largest(larger(even, odd));
}

SATCHECK_INLINE double ExpandingPolytope::least_proven_distance(HalfEdge closest) const {
  const double turned = visible_noise_;
  double least = distance(closest) - support_error_ - turned * std::sqrt(blocks_[closest / 16].stretch_squared[closest % 4]);
  for (std::size_t i = 0; i < blocks_used_; ++i) {
    const Lanes certain = load_lanes(blocks_[i].distance) - all_lanes(support_error_);
    const Lanes margin = certain - all_lanes(least), stretch_squared = load_lanes(blocks_[i].stretch_squared);
    const LaneMask no_less = (margin > all_lanes(0)) & (stretch_squared * all_lanes(turned * turned) < margin * margin);
    if (bits_of(no_less) == 15) continue;
    const Lanes proven = certain - square_root(stretch_squared) * turned;
    for (int l = 0; l < 4; ++l) least = smaller(least, proven[l]);
  }
  return least;
}

SATCHECK_INLINE bool ExpandingPolytope::start(const Simplex& tetrahedron) {
  make_room();
  const SupportPoint* v = tetrahedron.vertex;
  const bool turn = dot(cross(v[1].w - v[0].w, v[2].w - v[0].w), v[3].w - v[0].w) > 0;
  for (const int i : {0, turn ? 2 : 1, turn ? 1 : 2, 3}) add_vertex(v[i]);
  // The base, and the faces from its edges to the last vertex.
  static constexpr std::uint32_t vertex[12] = {0, 1, 0, 2, 1, 0, 2, 1, 2, 3, 3, 3};
  static constexpr HalfEdge twin[12] = {1, 0, 8, 4, 3, 10, 11, 9, 2, 7, 5, 6};
  FaceBlock& b = blocks_[take_block() / 16];
  std::copy(vertex, vertex + 12, b.vertex);
  std::copy(twin, twin + 12, b.twin);
  faces_in_[0] = 4;
  const bool wide = set_planes(b, gather(b.vertex), gather(b.vertex + 4), gather(b.vertex + 8), 4);
  return wide && b.distance[0] - dot(normal(0), vertices_[3].w) > thin_;
}

SATCHECK_INLINE bool ExpandingPolytope::set_planes(FaceBlock& b, const FourPoints& tail, const FourPoints& head,
                                                   const FourPoints& apex, std::size_t faces) const {
  const Lanes ax = head.x - tail.x, ay = head.y - tail.y, az = head.z - tail.z;
  const Lanes bx = apex.x - head.x, by = apex.y - head.y, bz = apex.z - head.z;
  const Lanes cx = tail.x - apex.x, cy = tail.y - apex.y, cz = tail.z - apex.z;
  const Lanes aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
  // The cross product of the two shortest edges has the least rounding error: a x b, b x c, or -a x c.
  const LaneMask a_longest = (aa >= bb) & (aa >= cc), c_longest = (cc > aa) & (cc > bb);
  const Lanes sign = select(a_longest | c_longest, all_lanes(1), all_lanes(-1));
  const Lanes ux = select(a_longest, bx, ax * sign), uy = select(a_longest, by, ay * sign), uz = select(a_longest, bz, az * sign);
  const Lanes vx = select(c_longest, bx, cx), vy = select(c_longest, by, cy), vz = select(c_longest, bz, cz);
  const Lanes nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const Lanes area_squared = nx * nx + ny * ny + nz * nz;  // twice the area
  const Lanes longest_squared = larger(larger(aa, bb), cc);
  const Lanes shortest_squared = select(a_longest, bb, aa) * select(c_longest, bb, cc);
  const Lanes inverse = all_lanes(1) / square_root(area_squared);
  const Lanes mx = nx * inverse, my = ny * inverse, mz = nz * inverse;
  const Lanes distance = mx * tail.x + my * tail.y + mz * tail.z;
  const Lanes lane = {0, 1, 2, 3};
  store_lanes(b.normal_x, mx);
  store_lanes(b.normal_y, my);
  store_lanes(b.normal_z, mz);
  store_lanes(b.stretch_squared, shortest_squared * inverse * inverse);
  store_lanes(b.distance, select(lane < all_lanes(static_cast<double>(faces)), distance, all_lanes(INFINITY)));
  return bits_of(area_squared > longest_squared * all_lanes(thin_ * thin_)) == 15;
}

// Removes the faces that the point sees, and lists the start vertices of the edges around them in the order of the
// loop. The walk enters a face over one edge and continues over its other two. The hidden half-edges become neighbours
// of the faces of a fan, whose blocks are listed. Returns 0 if the edges form no loop.
SATCHECK_INLINE std::uint32_t ExpandingPolytope::take_visible(Vec3 point, HalfEdge face) {
  FaceBlock* blocks = blocks_.data();
  HalfEdge *horizon = horizon_.data(), *pending = pending_.data(), *fan = fan_.data();
  std::uint32_t *tails = tails_.data(), *faces_in = faces_in_.data();
  std::uint32_t count = 0, depth = 2, head = 0, gaps = 0;
  HalfEdge base = 0;
  const auto take_away = [&](FaceBlock& b, HalfEdge h) {
    b.distance[h % 4] = INFINITY;
    if (--faces_in[h / 16] == 0) free_[free_count_++] = h & ~HalfEdge{15};
  };
  FaceBlock& seen = blocks[face / 16];
  take_away(seen, face);
  HalfEdge into = seen.twin[face % 4];
  pending[1] = seen.twin[4 + face % 4];
  pending[0] = seen.twin[8 + face % 4];
  for (;;) {
    FaceBlock& b = blocks[into / 16];
    const double distance = b.distance[into % 4];
    const HalfEdge second = next(into);
    if (distance != INFINITY && dot(normal_in(b, into), point) - distance > visible_noise_) {
      take_away(b, into);
      pending[depth++] = b.twin[next(second) % 16];
      into = b.twin[second % 16];
      continue;
    }
    if (distance != INFINITY) {
      if (count % 4 == 0) base = fan[count / 4] = take_block();
      b.twin[into % 16] = base++;
      horizon[count] = into;
      tails[count] = b.vertex[second % 16];
      gaps |= tails[count] ^ head;
      head = b.vertex[into % 16];
      if (++count == 1) gaps = 0;
    }
    if (depth == 0) break;
    into = pending[--depth];
  }
  return count < 3 || gaps != 0 || head != tails[0] ? 0 : count;
}

// Adds faces from the edges of the loop to a vertex.
SATCHECK_INLINE bool ExpandingPolytope::add_fan(std::uint32_t apex, std::uint32_t count) {
  FaceBlock* blocks = blocks_.data();
  const HalfEdge *horizon = horizon_.data(), *fan = fan_.data();
  std::uint32_t* tails = tails_.data();
  for (int i = 0; i < 7; ++i) tails[count + i] = tails[i];  // lanes without a face continue around the loop
  const Vec3 p = vertices_[apex].w;
  const FourPoints tip = {all_lanes(p.x), all_lanes(p.y), all_lanes(p.z)};
  FourPoints tail = gather(tails);
  HalfEdge last = fan[(count - 1) / 4] + (count - 1) % 4;
  bool wide = true;
  for (std::uint32_t i = 0; i < count; i += 4) {
    const HalfEdge edge = fan[i / 4];
    FaceBlock& b = blocks[edge / 16];
    std::copy_n(tails + i, 4, b.vertex);
    std::copy_n(tails + i + 1, 4, b.vertex + 4);
    std::fill_n(b.vertex + 8, 4, apex);
    std::copy_n(horizon + i, 4, b.twin);
    for (HalfEdge l = 0; l < 4; ++l) {
      b.twin[4 + l] = edge + 9 + l;  // the next face of the fan
      b.twin[8 + l] = edge + 3 + l;  // the previous face of the fan
    }
    b.twin[8] = last + 4;
    blocks[last / 16].twin[4 + last % 4] = edge + 8;
    last = edge + 3;
    faces_in_[edge / 16] = count - i < 4 ? count - i : 4;
    const FourPoints following = gather(tails + i + 4);
    const FourPoints head = {shuffle<1, 2, 3, 4>(tail.x, following.x), shuffle<1, 2, 3, 4>(tail.y, following.y),
                             shuffle<1, 2, 3, 4>(tail.z, following.z)};
    wide &= set_planes(b, tail, head, tip, count - i);
    tail = following;
  }
  const HalfEdge end = fan[(count - 1) / 4] + (count - 1) % 4;
  blocks[end / 16].twin[4 + end % 4] = fan[0] + 8;
  return wide;
}

SATCHECK_INLINE bool ExpandingPolytope::expand(const SupportPoint& point, HalfEdge face) {
  make_room();
  const std::uint32_t count = take_visible(point.w, face);
  return count > 0 && add_fan(add_vertex(point), count);
}

}  // namespace satcheck
