// The planes of all triangles cut space into cells with constant winding numbers. The relation of two bodies depends on
// three facts: which combinations of (in A, in B) occur, whether the boundaries meet, and how their sheets lie. A cell
// is bounded by pieces of triangles, so one exact generic point of every piece shows all combinations. Not every piece
// needs a sample:
//
// * Triangles without contact: each connected region lies on one side of the other surface. One winding number of the
//   other solid for each region is enough, with those of its own solid.
// * Triangles in contact: edges of the other mesh in its plane and triangles that cross it cut a triangle into pieces.
//   If its own mesh meets itself, that mesh cuts it too. One sample for each piece is enough, with the winding numbers
//   of both meshes on both sides.
// * When the pieces of one surface S are known, triangles of the other surface that do not meet their own mesh need no
//   cuts by S. A path between neighbouring cells inside, or outside, the other solid passes either no piece of S or a
//   piece that has already shown both combinations. A sheet meets its own mesh, so it is always cut.
// * Two sheets can cross along edges only, where winding numbers show nothing. A separate test decides this.
#include "mesh_pair/contact.hpp"

#include <algorithm>
#include <utility>

#include "exact/predicates.hpp"
#include "exact/triangle_pair.hpp"
#include "mesh/cuts.hpp"
#include "mesh/self_contact.hpp"
#include "mesh_pair/boundary_contact.hpp"
#include "mesh_pair/free_regions.hpp"
#include "mesh_pair/sheet_contact.hpp"

namespace satcheck {
namespace {

// Other triangles may pass through points of a crossing segment. They pass through all of these samples only if they
// contain the whole segment.
constexpr int kCrossingSamples = 4;

struct ContactTriangle {
  std::uint32_t triangle;
  std::vector<std::uint32_t> partners;  // of the other mesh
  std::vector<std::uint32_t> own;       // irregular partners in its own mesh
  std::vector<PlaneSegment> cuts;
};

class ContactSide {
 public:
  ContactSide(const Side& side, std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs) : side_(side) {
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [triangle, partner] : pairs) {
      if (contacts_.empty() || contacts_.back().triangle != triangle) contacts_.push_back({triangle, {}, {}, {}});
      contacts_.back().partners.push_back(partner);
    }
  }

  FreeRegions free_regions() const {
    if (contacts_.empty()) return {side_, {}};
    std::vector<bool> in_contact(side_.self.mesh.triangles.size(), false);
    for (const ContactTriangle& c : contacts_) in_contact[c.triangle] = true;
    return {side_, std::move(in_contact)};
  }

  // Returns the approximate number of stretches that bound the cut triangles.
  std::size_t prepare_cuts() {
    const Mesh& mesh = side_.self.mesh;
    std::size_t stretches = 0;
    std::erase_if(contacts_, [&](const ContactTriangle& c) {
      const Corners t = corners(mesh, c.triangle);
      return collinear(t[0], t[1], t[2]);
    });
    for (ContactTriangle& c : contacts_) {
      c.own = irregular_partners(side_.self, c.triangle, side_.budget);
      c.cuts = find_cuts(mesh, c.triangle, side_.other.mesh, c.partners, Touching::left_out, side_.budget);
      const auto own_cuts = find_cuts(mesh, c.triangle, mesh, c.own, Touching::left_out, side_.budget);
      c.cuts.insert(c.cuts.end(), own_cuts.begin(), own_cuts.end());
      stretches += c.cuts.empty() ? 1 : 3 + c.cuts.size();
    }
    return stretches;
  }

  enum class Cut { all, self_meeting };

  void sample(Cut cut, Samples& samples) const {
    for (const ContactTriangle& c : contacts_) {
      const bool whole = cut == Cut::self_meeting && c.own.empty();
      const bool goes_on = visit_pieces(
          corners(side_.self.mesh, c.triangle), whole ? std::vector<PlaneSegment>{} : c.cuts,
          Touching::left_out, [&](const Piece& piece) {
            const bool known = sample_piece(piece, c.partners.size() + c.own.size(), [&](const ExactPoint& p) {
              return samples.note_at(side_, c.triangle, c.partners[0], p);
            });
            if (!known) samples.fail();
            return !samples.settled();
          }, side_.budget);
      if (!goes_on) return;
    }
  }

 private:
  Side side_;
  std::vector<ContactTriangle> contacts_;
};

// Notes a generic point of a crossing. Each body has one winding number on each side of its triangle, and the triangle
// of the other body passes from one side to the other.
bool note_crossing(const Surface& a, const Surface& b, ContactPair crossing, const LazyPoint& p, Samples& samples,
                   Budget* budget) {
  const auto of_a = beside_inner(a, p, crossing.a, budget), of_b = beside_inner(b, p, crossing.b, budget);
  if (!of_a || !of_b) return false;
  const Evidence where{crossing.a, crossing.b, p.rounded};
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

void sample_pieces(ContactSide& a, ContactSide& b, Samples& samples) {
  const bool a_first = a.prepare_cuts() <= b.prepare_cuts();
  (a_first ? a : b).sample(ContactSide::Cut::all, samples);
  if (!samples.settled()) (a_first ? b : a).sample(ContactSide::Cut::self_meeting, samples);
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

PairFacts judge_contact(const Surface& a, const Surface& b, const std::vector<ContactPair>& contacts, Wanted wanted,
                        Budget* budget) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> from_a, from_b;
  for (const ContactPair& c : contacts) {
    from_a.emplace_back(c.a, c.b);
    from_b.emplace_back(c.b, c.a);
  }
  ContactSide side_a({a, b, true, budget}, std::move(from_a)), side_b({b, a, false, budget}, std::move(from_b));
  Samples samples;
  const FreeRegions free[] = {side_a.free_regions(), side_b.free_regions()};
  const bool apart = contacts.empty() && std::none_of(std::begin(free), std::end(free), [](const FreeRegions& f) { return f.any_inside(); });
  if (apart) return samples.facts();
  find_plain_contact(a, b, contacts, samples, budget);
  for (const FreeRegions& f : free) f.sample_first(samples);
  for (const FreeRegions& f : free) f.sample_rest(samples);
  if (samples.settled()) return samples.facts();
  sample_pieces(side_a, side_b, samples);
  if (!samples.facts().common) find_sheet_crossing(a, b, contacts, samples, budget);
  if (wanted == Wanted::relation && samples.contact_matters()) find_any_contact(a, b, contacts, samples, budget);
  return samples.facts();
}

}  // namespace satcheck
