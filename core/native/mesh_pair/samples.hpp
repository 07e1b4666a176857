// What exact sample points show of a pair of surfaces.
#pragma once

#include "exact/triangle_pair.hpp"
#include "mesh/flat_cells.hpp"
#include "mesh/surface.hpp"
#include "mesh/winding.hpp"
#include "mesh_pair/pair_facts.hpp"

namespace satcheck {

// One surface, seen against the other one. Both are closed.
struct Side {
  const Surface& self;
  const Surface& other;
  bool self_is_a;

  Evidence evidence(std::uint32_t mine, std::uint32_t theirs, Vec3 point) const {
    return self_is_a ? Evidence{mine, theirs, point} : Evidence{theirs, mine, point};
  }
};

// Winding numbers of the surface beside a point of triangle t of any mesh; nothing when the point lies on
// a triangle of the surface in another plane.
inline std::optional<Beside> beside(const Surface& s, const ExactPoint& p, const Corners& t) {
  return winding_beside(s.mesh, s.bvh, p, t[0], t[1], t[2]);
}

// The same beside a point that is known to be inside triangle t of the surface.
inline std::optional<Beside> beside_inner(const Surface& s, const LazyPoint& p, std::uint32_t t) {
  const Corners c = corners(s.mesh, t);
  return winding_beside(s.mesh, s.bvh, p, c[0], c[1], c[2], t);
}

class Samples {
 public:
  const PairFacts& facts() const { return facts_; }
  bool settled() const { return facts_.settled(); }

  // Could winding number `theirs` of the other solid at a point of side.self add a fact?
  bool may_learn(const Side& side, int theirs) const {
    if (settled()) return false;
    return theirs == 0 ? !alone(side, true) : !facts_.common || !alone(side, false);
  }

  // Does the relation depend on whether there is contact, which is not known yet?
  bool contact_matters() const {
    return !facts_.contact && (!facts_.common || facts_.a_alone != facts_.b_alone);
  }

  // The winding numbers on both sides of a triangle of side.self, next to a generic point of it.
  void note_beside(const Side& side, const Beside& mine, const Beside& theirs, const Evidence& where) {
    note(side, mine.front, theirs.front, where);
    note(side, mine.back, theirs.back, where);
    if (mine.is_sheet()) note_sheet(side, true, theirs, where);
    if (theirs.is_sheet()) note_sheet(side, false, mine, where);
    if (mine.is_boundary() && theirs.is_boundary()) note_contact(where);
  }

  // A sheet of side.self (self), or of the other body, next to a point where the body that it is no part of has
  // these winding numbers.
  void note_sheet(const Side& side, bool self, const Beside& other, const Evidence& where) {
    if (other.front != 0 && other.back != 0 && !facts_.common) {
      facts_.common = true;
      facts_.overlap = where;
    }
    if (other.front == 0 && other.back == 0 && !other.on_surface) alone(side, self) = true;
  }

  // Two sheets pass through each other.
  void note_sheets_cross(const Evidence& where) {
    if (!facts_.common) facts_.overlap = where;
    facts_.common = facts_.a_alone = facts_.b_alone = true;
    note_contact(where);
  }

  // The winding numbers at one point.
  void note(const Side& side, int mine, int theirs, const Evidence& where) {
    if (mine != 0 && theirs != 0 && !facts_.common) {
      facts_.common = true;
      facts_.overlap = where;
    }
    if (mine != 0 && theirs == 0) alone(side, true) = true;
    if (mine == 0 && theirs != 0) alone(side, false) = true;
  }

  void note_contact(const Evidence& where) {
    if (!facts_.contact) facts_.touch = where;
    facts_.contact = true;
  }

  // A point of triangle t of side.self, where the other surface's winding number is `theirs`. False when
  // that of its own surface could not be told.
  bool note_free(const Side& side, std::uint32_t t, const ExactPoint& p, int theirs);

  // The same for any point; `partner` is the triangle to name beside t.
  bool note_at(const Side& side, std::uint32_t t, std::uint32_t partner, const ExactPoint& p);

  void fail() { facts_.proven = false; }

 private:
  bool& alone(const Side& side, bool self) {
    return self == side.self_is_a ? facts_.a_alone : facts_.b_alone;
  }
  bool alone(const Side& side, bool self) const {
    return self == side.self_is_a ? facts_.a_alone : facts_.b_alone;
  }

  PairFacts facts_;
};

// Tries points of the piece until note(point) returns true. A point gives no answer where it lies on a
// triangle in another plane: at single points of a piece that is cut by all of them, and at no more than
// two of the points where one that is not cut meets a line. `others`: how many triangles it meets.
template <class Note>
bool sample_piece(const Piece& piece, std::size_t others, Note note) {
  for (std::size_t k = 0; k <= 2 * others; ++k) {
    if (note(piece.sample(static_cast<int>(k)))) return true;
  }
  return false;
}

}  // namespace satcheck
