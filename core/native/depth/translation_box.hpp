// Boxes in the space of translations, which the search for the depth cuts in halves.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.hpp"
#include "depth/forbidden_set.hpp"

namespace satcheck {

struct TranslationBox {
  double key;  // distance of its nearest point from the origin
  Vec3 centre, half;
  // Those of the first `seen` forbidden sets that may contain a part of it. Facets that the box does not reach may be left
  // out of them.
  std::vector<std::shared_ptr<const ForbiddenSet>> sets;
  std::uint32_t seen;
  std::uint64_t number;
  std::uint32_t part = 0;  // of the record
  std::uint32_t held_by = 0;  // the set that holds the most of it

  Vec3 nearest_to_origin() const;
  bool contains(Vec3 t) const;
  Aabb bounds() const { return {centre - half, centre + half}; }
};

// The order of a queue with the box nearest to the origin on top. Among equal boxes, the one with the least number.
struct Later {
  bool operator()(const TranslationBox& a, const TranslationBox& b) const {
    return a.key != b.key ? a.key > b.key : a.number > b.number;
  }
};

// The part of a translation in the plane across an axis of the world, 0, 1 or 2; all of it for -1.
Vec3 in_plane(Vec3 t, int across);

// Half the side of a cube around the origin that contains all translations of at most this length. It has so few digits
// that centres are exact after about 90 halvings, 30 for each axis.
double root_half(double length);

}  // namespace satcheck
