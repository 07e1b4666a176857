// The known facts about two bodies, and the relation that follows from them.
//
// A body is its solid part and its sheets. The solid part is the set of points of winding number != 0. A
// sheet is a piece of a triangle with winding number 0 on both sides: material without an inside. Nothing
// lies within a sheet, and whatever crosses a sheet crosses the body. The boundary is where the solid part
// ends, and the sheets. A face with material on both sides belongs to the inside.
#pragma once

#include <optional>

#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

struct Evidence {
  std::uint32_t triangle_a, triangle_b;  // kNoIndex: none
  Vec3 point;                            // rounded
};

struct PairFacts {
  // There is a common inner point (of a sheet all points are inner), or two sheets cross.
  bool common = false;
  bool a_alone = false;  // there is an inner point of A outside of B
  bool b_alone = false;
  bool contact = false;  // the boundaries have a common point
  std::optional<Evidence> overlap;  // evidence for `common`
  std::optional<Evidence> touch;    // evidence for `contact`
  bool proven = true;  // false: a sample that might have shown another fact gave no answer

  // Further facts would not change the relation.
  bool settled() const { return common && (a_alone || b_alone) && (contact || (a_alone && b_alone)); }

  // For facts that are settled, or complete.
  Relation relation() const {
    if (!common) return contact ? Relation::touching : Relation::separated;
    if (!a_alone && !b_alone) return Relation::coincident;
    if (contact || (a_alone && b_alone)) return Relation::penetrating;
    return a_alone ? Relation::contains : Relation::inside;
  }
};

}  // namespace satcheck
