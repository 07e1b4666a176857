// The facts about unions of boxes, against the cells and corners of their lattice.
#include "mesh_pair/contact.hpp"

#include "mesh_pair/traversal.hpp"
#include "tests/boxes.hpp"
#include "tests/check.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

constexpr int kSize = 5;

// Whether a point of the lattice of half cells, in half cells, lies on the boundary: some cells around it are in the
// body and some are not.
bool on_boundary(const WholeBoxes& boxes, int x, int y, int z) {
  bool in = false, out = false;
  const auto cells = [](int at) { return at % 2 == 0 ? std::pair{at / 2 - 1, at / 2} : std::pair{at / 2, at / 2}; };
  const auto [x0, x1] = cells(x);
  const auto [y0, y1] = cells(y);
  const auto [z0, z1] = cells(z);
  for (const int i : {x0, x1})
    for (const int j : {y0, y1})
      for (const int k : {z0, z1}) (cell_in(boxes, i, j, k) ? in : out) = true;
  return in && out;
}

PairFacts truth(const WholeBoxes& a, const WholeBoxes& b) {
  PairFacts facts;
  for (int x = 0; x < kSize; ++x)
    for (int y = 0; y < kSize; ++y)
      for (int z = 0; z < kSize; ++z) {
        const bool in_a = cell_in(a, x, y, z), in_b = cell_in(b, x, y, z);
        facts.common = facts.common || (in_a && in_b);
        facts.a_alone = facts.a_alone || (in_a && !in_b);
        facts.b_alone = facts.b_alone || (in_b && !in_a);
      }
  for (int x = 0; x <= 2 * kSize; ++x)
    for (int y = 0; y <= 2 * kSize; ++y)
      for (int z = 0; z <= 2 * kSize; ++z) {
        facts.contact = facts.contact || (on_boundary(a, x, y, z) && on_boundary(b, x, y, z));
      }
  return facts;
}

// A fact that is claimed is true.
bool holds(const PairFacts& claimed, const PairFacts& all) {
  return (all.common || !claimed.common) && (all.a_alone || !claimed.a_alone) && (all.b_alone || !claimed.b_alone) &&
         (all.contact || !claimed.contact);
}

// The same solid of other triangles: its first box in two.
WholeBoxes cut(WholeBoxes boxes) {
  WholeBox& first = boxes[0];
  if (first.high[0] - first.low[0] < 2) return boxes;
  WholeBox rest = first;
  first.high[0] = rest.low[0] = first.low[0] + 1;
  boxes.push_back(rest);
  return boxes;
}

// An affine map with whole numbers changes no relation, and takes the faces off the axes.
Surface sheared(const WholeBoxes& boxes, Vec3 shear) {
  Mesh mesh = mesh_of(boxes);
  for (Vec3& v : mesh.vertices) v = {v.x + shear.x * v.y + shear.y * v.z, v.y + shear.z * v.z, v.z};
  return make_surface(mesh, true);
}

void lattices() {
  std::mt19937 generator(8);
  int of_kind[6] = {};
  for (int round = 0; round < rounds(4000); ++round) {
    WholeBoxes boxes_a = random_boxes(generator, 1 + round % 3, kSize);
    WholeBoxes boxes_b = round % 10 == 0 ? cut(boxes_a) : random_boxes(generator, 1 + round / 3 % 3, kSize);
    if (round % 10 == 1) boxes_a.push_back({{0, 0, 0}, {kSize, kSize, kSize}});
    if (round % 10 == 2) boxes_b.push_back({{0, 0, 0}, {kSize, kSize, kSize}});
    const PairFacts all = truth(boxes_a, boxes_b);
    const Vec3 shear = round % 2 == 0 ? Vec3{} : Vec3{round % 3 - 1.0, round % 5 - 2.0, round % 7 - 3.0};
    const Surface a = sheared(boxes_a, shear), b = sheared(boxes_b, shear);
    const SurfaceContacts contacts = find_contacts(a, b, AtCrossing::go_on);
    const PairFacts relation = judge_contact(a, b, contacts, Wanted::relation);
    CHECK(relation.proven && holds(relation, all) && relation.relation() == all.relation());
    const PairFacts overlap = judge_contact(a, b, contacts, Wanted::overlap);
    CHECK(overlap.proven && holds(overlap, all) && overlap.common == all.common);
    if (contacts.crossing) CHECK(holds(facts_at_crossing(a, b, *contacts.crossing), all));
    ++of_kind[static_cast<int>(all.relation())];
  }
  // Each relation was met, so that none of them is trivially right.
  CHECK(std::all_of(std::begin(of_kind), std::end(of_kind), [](int count) { return count > 0; }));
}

}  // namespace

UNIT(contact) { lattices(); }
