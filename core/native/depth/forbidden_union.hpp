// All forbidden sets that a search has found so far, with queries about a box or a point against all of them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "depth/forbidden_set.hpp"
#include "depth/planes.hpp"

namespace satcheck {

struct TranslationBox {
  Vec3 centre, half;
  // Those of the first `seen` forbidden sets that may contain a part of it. Facets that the box does not reach may be left
  // out of them.
  std::vector<std::shared_ptr<const ForbiddenSet>> sets;
  std::uint32_t seen;
  std::uint32_t part = 0;  // of the record
  std::uint32_t held_by = 0;  // the set that holds the most of it

  Vec3 nearest_to_origin() const;
  bool contains(Vec3 t) const;
  Aabb bounds() const { return {centre - half, centre + half}; }
};

// The part of a translation in the plane across an axis of the world, 0, 1 or 2; all of it for -1.
Vec3 in_plane(Vec3 t, int across);

// Half the side of a cube around the origin that contains all translations of at most this length. It has so few digits
// that centres are exact after about 90 halvings, 30 for each axis.
double root_half(double length);

// Lengths are those of translations.
class ForbiddenUnion {
 public:
  // across: an axis of the world along which nothing is moved; -1: none.
  ForbiddenUnion(int across, Budget& budget) : across_(across), budget_(budget) {}

  void add(ForbiddenSet set) {
    set.number = static_cast<std::uint32_t>(sets_.size());
    sets_.push_back(std::make_shared<const ForbiddenSet>(std::move(set)));
  }
  std::size_t size() const { return sets_.size(); }

  // A length up to which a single set contains all translations in the box; -infinite if it is less than `least`. The
  // search for a longer one ends at `most`. Stores in box.sets which sets may contain a part of the box.
  double covered_by_one(TranslationBox& box, double least, double most) const;

  // The same by one set and, for each part of the box beyond a facet of that set, one more set. With this, two sets
  // that overlap only a little cover their seam in few boxes.
  double covered_by_several(const TranslationBox& box, double least);

  // Whether t is shorter than `most` and in no set of the box.
  bool is_open(const TranslationBox& box, Vec3 t, double most) const;

  // The point nearest to t that is in no set of the box, if it is in the box and shorter than `most`.
  std::optional<Vec3> nearest_open(const TranslationBox& box, Vec3 t, double most) const;

  // The box's nearest point to the origin, shifted onto the facets that cut the box.
  Vec3 on_facets(const TranslationBox& box) const;

  bool holds(Vec3 t) const;

  // The exit from the set in which t is deepest; depth 0 if t is in no set.
  ForbiddenSet::Exit deepest_exit(Vec3 t) const;

 private:
  double covered_with(const ForbiddenSet& first, const TranslationBox& box, double least);

  int across_;
  Budget& budget_;
  std::vector<std::shared_ptr<const ForbiddenSet>> sets_;
  std::vector<Wall> cuts_;  // buffer for covered_with()
};

}  // namespace satcheck
