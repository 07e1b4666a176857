// Facts about a pair of surfaces from exact sample points.
#pragma once

#include <unordered_map>

#include "exact/triangle_pair.hpp"
#include "mesh/plane_cells.hpp"
#include "mesh/surface.hpp"
#include "mesh/winding.hpp"
#include "mesh_pair/pair_facts.hpp"

namespace satcheck {

// One surface and the other one. Both are closed.
struct Side {
  const Surface& self;
  const Surface& other;
  bool self_is_a;
  Budget* budget;

  Evidence evidence(std::uint32_t mine, std::uint32_t theirs, Vec3 point) const {
    return self_is_a ? Evidence{mine, theirs, point} : Evidence{theirs, mine, point};
  }
};

// Winding numbers of the surface beside a point that is known to be inside its triangle t.
inline std::optional<Beside> beside_inner(const Surface& s, const LazyPoint& p, std::uint32_t t, Budget* budget) {
  const Corners c = corners(s.mesh, t);
  return winding_beside(s.mesh, s.bvh, p, c[0], c[1], c[2], t, budget);
}

class Samples {
 public:
  const PairFacts& facts() const { return facts_; }
  bool settled() const { return facts_.settled(); }

  // Whether winding number `theirs` of the other solid at a point of side.self could add a fact.
  bool may_learn(const Side& side, int theirs) const {
    if (settled()) return false;
    return theirs == 0 ? !alone(side, true) : !facts_.common || !alone(side, false);
  }

  // Whether the relation depends on contact, which is still unknown.
  bool contact_matters() const {
    return !facts_.contact && (!facts_.common || facts_.a_alone != facts_.b_alone);
  }

  // where(): the evidence, for a fact that is new. The winding numbers on both sides of a triangle of side.self, next to a generic point of it.
  template <class Where>
  void note_beside(const Side& side, const Beside& mine, const Beside& theirs, const Where& where) {
    note(side, mine.front, theirs.front, where);
    note(side, mine.back, theirs.back, where);
    if (mine.is_sheet()) note_sheet(side, true, theirs, where);
    if (theirs.is_sheet()) note_sheet(side, false, mine, where);
    if (mine.is_boundary() && theirs.is_boundary()) note_contact(where);
  }

  // Notes a sheet of side.self (self) or of the other body. other: winding numbers, beside the sheet, of the body that
  // it does not belong to.
  template <class Where>
  void note_sheet(const Side& side, bool self, const Beside& other, const Where& where) {
    if (other.front != 0 && other.back != 0 && !facts_.common) {
      facts_.common = true;
      facts_.overlap = where();
    }
    if (other.front == 0 && other.back == 0 && !other.on_surface) alone(side, self) = true;
  }

  // Two sheets pass through each other.
  template <class Where>
  void note_sheets_cross(const Where& where) {
    if (!facts_.common) facts_.overlap = where();
    facts_.common = facts_.a_alone = facts_.b_alone = true;
    note_contact(where);
  }

  // The winding numbers at one point.
  template <class Where>
  void note(const Side& side, int mine, int theirs, const Where& where) {
    if (mine != 0 && theirs != 0 && !facts_.common) {
      facts_.common = true;
      facts_.overlap = where();
    }
    if (mine != 0 && theirs == 0) alone(side, true) = true;
    if (mine == 0 && theirs != 0) alone(side, false) = true;
  }

  template <class Where>
  void note_contact(const Where& where) {
    if (!facts_.contact) facts_.touch = where();
    facts_.contact = true;
  }

  // Notes a point of triangle t of side.self; `partner`: the triangle to name beside it. False: not decided.
  template <class Point>
  bool note_point(const Side& side, std::uint32_t t, std::uint32_t partner, const Point& p, const std::optional<Beside>& mine,
                  const std::optional<Beside>& theirs) {
    if (!mine || !theirs) return false;
    note_beside(side, *mine, *theirs, [&] { return side.evidence(t, partner, p.rounded); });
    return true;
  }

  // The cells of a patch of side.self (0) and side.other (1). partner(t): the triangle to name beside one that is alone in
  // the patch.
  template <class Partner>
  void note_cells(const Side& side, const PlaneCells& cells, Partner partner) {
    bool sheets[2] = {true, true}, solids[2] = {true, true};  // whether all cells of a surface are of this kind
    for (const std::uint32_t cell : cells.cells()) {
      if (settled()) return;
      const auto mine = cells.beside(cell, 0), theirs = cells.beside(cell, 1);
      for (int s = 0; s < 2; ++s) {
        const auto& beside = s == 0 ? mine : theirs;
        if (beside && !beside->on_surface) continue;
        sheets[s] = sheets[s] && beside && beside->is_sheet();
        solids[s] = solids[s] && beside && !beside->is_sheet();
      }
      if (!mine || !theirs) {
        fail();
        continue;
      }
      note_beside(side, *mine, *theirs, [&] {
        const ExactPoint p = cells.inside(cell);
        std::uint32_t t = kNoIndex, u = kNoIndex;
        for (const PatchTriangle& member : cells.members_at(p)) {
          std::uint32_t& first = member.surface == 0 ? t : u;
          if (first == kNoIndex) first = member.triangle;
        }
        if (t == kNoIndex) t = partner(PatchTriangle{1, u});
        if (u == kNoIndex) u = partner(PatchTriangle{0, t});
        return side.evidence(t, u, p.rounded);
      });
    }
    for (const PatchTriangle& member : cells.members()) {
      const int s = member.surface;
      if (sheets[s] || solids[s]) is_sheet_[(s == 0) == side.self_is_a ? 0 : 1][member.triangle] = sheets[s];
    }
  }

  // Whether triangles of A (0) and B (1) are sheets, of those whose patches have shown it.
  const std::unordered_map<std::uint32_t, bool>& is_sheet(int body) const { return is_sheet_[body]; }

  void fail() { facts_.proven = false; }

 private:
  bool& alone(const Side& side, bool self) {
    return self == side.self_is_a ? facts_.a_alone : facts_.b_alone;
  }
  bool alone(const Side& side, bool self) const {
    return self == side.self_is_a ? facts_.a_alone : facts_.b_alone;
  }

  PairFacts facts_;
  std::unordered_map<std::uint32_t, bool> is_sheet_[2];
};

}  // namespace satcheck
