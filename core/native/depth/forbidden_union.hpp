// All forbidden sets that a search has found so far, and what they say of a box or a point together.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "depth/forbidden_set.hpp"
#include "depth/translation_box.hpp"
#include "mesh_pair/wall_corner.hpp"

namespace satcheck {

// Lengths are those of translations. Counts its steps in work_done (base/work.hpp).
class ForbiddenUnion {
 public:
  // across: an axis of the world along which nothing is moved; -1: none.
  explicit ForbiddenUnion(int across) : across_(across) {}

  void add(ForbiddenSet set) { sets_.push_back(std::move(set)); }
  std::size_t size() const { return sets_.size(); }

  // A length up to which one set holds all translations in the box; -infinite where that is less than `least`. The
  // search for a longer one ends at `most`. Notes in box.sets which sets may hold a part of it.
  double covered_by_one(TranslationBox& box, double least, double most) const;

  // The same by one set and, for each part of the box beyond a facet of that set, one more. So two sets that overlap
  // only a little cover the seam between them in few boxes.
  double covered_by_several(const TranslationBox& box, double least);

  // Whether t is shorter than `most` and no set of the box holds it.
  bool is_open(const TranslationBox& box, Vec3 t, double most) const;

  // The point nearest to t that no set of the box holds, if it is in the box and shorter than `most`.
  std::optional<Vec3> nearest_open(const TranslationBox& box, Vec3 t, double most) const;

  // The box's nearest point to the origin, shifted onto the facets that cut the box.
  Vec3 on_facets(const TranslationBox& box) const;

  bool holds(Vec3 t) const;

  // Out of the set that holds t deepest; depth 0 where none does.
  ForbiddenSet::Exit deepest_exit(Vec3 t) const;

 private:
  double covered_with(std::uint32_t first, const TranslationBox& box, double least);

  int across_;
  std::vector<ForbiddenSet> sets_;
  std::vector<Wall> cuts_;  // of covered_with(), kept for its memory
};

}  // namespace satcheck
