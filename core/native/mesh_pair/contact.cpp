// The planes of all triangles cut space into cells with constant winding numbers. The relation of two bodies depends on
// three facts: which combinations of (in A, in B) occur, whether the boundaries meet, and how their sheets lie. A cell
// is bounded by pieces of triangles, so the winding numbers beside every piece show all combinations. Not every piece
// has to be known:
//
// * Triangles without contact: each connected region lies on one side of the other surface. One winding number of the
//   other solid for each region is enough, with those of its own solid.
// * Triangles in contact: mesh/plane_cells.hpp cuts them into pieces, with all triangles that overlap them in their
//   plane, and finds the winding numbers of both meshes on both sides.
// * When the pieces of one surface S are known, triangles of the other surface that do not meet their own mesh need no
//   cuts by S. A path between neighbouring cells inside, or outside, the other solid passes either no piece of S or a
//   piece that has already shown both combinations. A sheet meets its own mesh, so it is always cut.
// * Two sheets can cross along edges only, where winding numbers show nothing. A separate test decides this.
#include "mesh_pair/contact.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/plane_cells.hpp"
#include "mesh/self_contact.hpp"
#include "mesh_pair/boundary_contact.hpp"
#include "mesh_pair/free_regions.hpp"
#include "mesh_pair/sheet_contact.hpp"
#include "mesh_pair/traversal.hpp"

namespace satcheck {
namespace {

// Other triangles may pass through points of a crossing segment. They pass through all of these samples only if they
// contain the whole segment.
constexpr int kCrossingSamples = 4;

struct ContactTriangle {
  std::uint32_t triangle;
  std::uint32_t partner;  // the first one, of the other mesh
  std::size_t partners;
};

class ContactSide {
 public:
  ContactSide(const Side& side, const std::vector<ContactPair>& contacts) : side_(side) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    pairs.reserve(contacts.size());
    for (const ContactPair& c : contacts) pairs.push_back(side.self_is_a ? std::pair(c.a, c.b) : std::pair(c.b, c.a));
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [triangle, partner] : pairs) {
      if (contacts_.empty() || contacts_.back().triangle != triangle) contacts_.push_back({triangle, partner, 0});
      ++contacts_.back().partners;
    }
  }

  FreeRegions free_regions(const SurfaceContacts& contacts) const {
    if (!contacts.any()) return {side_, {}};
    std::vector<bool> in_contact(side_.self.mesh.triangles.size(), false);
    for (const ContactTriangle& c : contacts_) in_contact[c.triangle] = true;
    for (const auto& region : contacts.common) {
      for (const ContactPair& c : region) in_contact[side_.self_is_a ? c.a : c.b] = true;
    }
    return {side_, std::move(in_contact)};
  }

  std::size_t count() const { return contacts_.size(); }

  enum class Cut { all, self_meeting };

  // other: the other side, whose triangles are named beside those of this one.
  void sample(Cut cut, const ContactSide& other, Samples& samples) {
    for (const ContactTriangle& c : contacts_) {
      const Corners t = corners(side_.self.mesh, c.triangle);
      if (samples.settled()) return;
      if (is_collinear(t) || sampled_.contains(c.triangle)) continue;
      if (cut == Cut::self_meeting && !has_irregular_partners(side_.self, c.triangle, side_.budget)) {
        if (!sample_triangle(c, t, samples)) samples.fail();
      } else {
        sample_patch(c.triangle, other, samples);
      }
    }
  }

  // Triangles that patches of the other side contain.
  void leave_out(const ContactSide& other) { sampled_.insert(other.sampled_there_.begin(), other.sampled_there_.end()); }

 private:
  // Tries points of the triangle. One gives no answer if it lies on a triangle in another plane. Such a triangle meets
  // this one in a line, and no three of the points lie on a line.
  bool sample_triangle(const ContactTriangle& contact, const Corners& t, Samples& samples) const {
    const auto beside = [&](const Surface& s, const ExactPoint& p) {
      return winding_beside(s.mesh, s.bvh, p, t[0], t[1], t[2], {}, side_.budget);
    };
    for (std::size_t k = 0; k <= 2 * contact.partners; ++k) {
      const double n = 1.0 + static_cast<double>(k);
      const ExactPoint p = weighted_point(t[0], t[1], t[2], n, n * n, 1.0);
      const auto theirs = beside(side_.other, p);
      if (theirs && samples.note_point(side_, contact.triangle, contact.partner, p, beside(side_.self, p), theirs)) return true;
    }
    return false;
  }

  void sample_patch(std::uint32_t triangle, const ContactSide& other, Samples& samples) {
    const PlaneCells cells({&side_.self, &side_.other}, {0, triangle}, SinglePoints::left_out, side_.budget);
    for (const PatchTriangle& member : cells.members()) {
      (member.surface == 0 ? sampled_ : sampled_there_).insert(member.triangle);
    }
    samples.note_cells(side_, cells, [&](PatchTriangle t) { return (t.surface == 0 ? *this : other).partner_of(t.triangle); });
  }

  std::uint32_t partner_of(std::uint32_t triangle) const {
    const auto at = std::lower_bound(contacts_.begin(), contacts_.end(), triangle,
                                     [](const ContactTriangle& c, std::uint32_t t) { return c.triangle < t; });
    return at != contacts_.end() && at->triangle == triangle ? at->partner : kNoIndex;
  }

  Side side_;
  std::vector<ContactTriangle> contacts_;
  std::unordered_set<std::uint32_t> sampled_, sampled_there_;  // triangles of patches: of this side, of the other
};

// Notes a generic point of a crossing. Each body has one winding number on each side of its triangle, and the triangle
// of the other body passes from one side to the other.
bool note_crossing(const Surface& a, const Surface& b, ContactPair crossing, const LazyPoint& p, Samples& samples,
                   Budget* budget) {
  const auto of_a = beside_inner(a, p, crossing.a, budget), of_b = beside_inner(b, p, crossing.b, budget);
  if (!of_a || !of_b) return false;
  const auto where = [&] { return Evidence{crossing.a, crossing.b, p.rounded}; };
  const Side side{a, b, true, budget};
  if (of_a->is_sheet() && of_b->is_sheet()) {
    samples.note_sheets_cross(where);
    return true;
  }
  for (const int in_a : {of_a->front, of_a->back}) {
    const Beside beside_b{in_a, in_a};  // next to the triangle of B, on this side of that of A
    if (of_b->is_sheet()) samples.note_sheet(side, false, beside_b, where);
    for (const int in_b : {of_b->front, of_b->back}) samples.note(side, in_a, in_b, where);
  }
  for (const int in_b : {of_b->front, of_b->back}) {
    if (of_a->is_sheet()) samples.note_sheet(side, true, {in_b, in_b}, where);
  }
  if (of_a->is_boundary() && of_b->is_boundary()) samples.note_contact(where);
  return true;
}

// One sample for each region of common triangles.
void sample_common(const Surface& a, const Surface& b, const SurfaceContacts& contacts, Samples& samples, Budget* budget) {
  for (const auto& region : contacts.common) {
    if (samples.settled()) return;
    const Corners c = corners(a.mesh, region[0].a);
    const LazyPoint p = lazy_centroid(c);
    const auto of_a = beside_inner(a, p, region[0].a, budget);
    const auto of_b = winding_beside(b.mesh, b.bvh, p, c[0], c[1], c[2], {}, budget);
    if (!samples.note_point({a, b, true, budget}, region[0].a, region[0].b, p, of_a, of_b)) samples.fail();
  }
}

// First the side with fewer triangles, which are the larger ones: the triangles of the other side are rarely cut then.
void sample_patches(ContactSide& a, ContactSide& b, Samples& samples) {
  ContactSide &first = a.count() <= b.count() ? a : b, &second = &first == &a ? b : a;
  first.sample(ContactSide::Cut::all, second, samples);
  second.leave_out(first);
  second.sample(ContactSide::Cut::self_meeting, first, samples);
}

}  // namespace

PairFacts facts_at_crossing(const Surface& a, const Surface& b, ContactPair crossing, Budget* budget) {
  const auto [first, last] = crossing_ends(corners(a.mesh, crossing.a), corners(b.mesh, crossing.b));
  const LazyPoint from = lazy_meeting_point(first.plane, first.p, first.q);
  const LazyPoint to = lazy_meeting_point(last.plane, last.p, last.q);
  Samples samples;
  for (int k = 1; k <= kCrossingSamples; ++k) {
    if (note_crossing(a, b, crossing, lazy_between(from, to, 1, k), samples, budget)) break;
  }
  return samples.facts();
}

PairFacts judge_contact(const Surface& a, const Surface& b, const SurfaceContacts& contacts, Wanted wanted, Budget* budget) {
  ContactSide side_a({a, b, true, budget}, contacts.contacts), side_b({b, a, false, budget}, contacts.contacts);
  Samples samples;
  const FreeRegions free[] = {side_a.free_regions(contacts), side_b.free_regions(contacts)};
  const bool apart = !contacts.any() && std::none_of(std::begin(free), std::end(free), [](const FreeRegions& f) { return f.any_inside(); });
  if (apart) return samples.facts();
  find_plain_contact(a, b, contacts.contacts, samples, budget);
  sample_common(a, b, contacts, samples, budget);
  for (const FreeRegions& f : free) f.sample_first(samples);
  for (const FreeRegions& f : free) f.sample_rest(samples);
  if (samples.settled()) return samples.facts();
  sample_patches(side_a, side_b, samples);
  if (!samples.facts().common) find_sheet_crossing(a, b, contacts.contacts, samples, budget);
  if (wanted == Wanted::relation && samples.contact_matters()) {
    // Two common triangles may have a corner in common that is boundary of A in one of them and of B in the other.
    const bool all = contacts.common.empty();
    find_any_contact(a, b, all ? contacts.contacts : find_contacts(a, b, AtCrossing::go_on, budget).contacts, samples, budget);
  }
  return samples.facts();
}

}  // namespace satcheck
