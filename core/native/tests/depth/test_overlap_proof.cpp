// Sets of translations that are proven to leave an overlap, against the boxes themselves.
#include "depth/overlap_proof.hpp"

#include "mesh/transform.hpp"
#include "tests/check.hpp"
#include "tests/depth/free_cells.hpp"

using namespace satcheck;
using namespace satcheck::testing;

namespace {

// Whole and half coordinates: translations are exact.
Vec3 random_half(std::mt19937& generator) {
  const auto half = [&] { return 0.5 * std::uniform_int_distribution<int>(-6, 6)(generator); };
  return {half(), half(), half()};
}

void check_set(const ForbiddenSet& set, const WholeBoxes& a, const WholeBoxes& b, Vec3 t, std::mt19937& generator) {
  CHECK(overlap_after(a, b, t));
  const double depth = set.exit(t).depth;
  // The ball of that radius about t, and all of the set that samples meet.
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  for (int sample = 0; sample < 60; ++sample) {
    const Vec3 d{normal(generator), normal(generator), normal(generator)};
    if (depth > 0) CHECK(overlap_after(a, b, t + d * (depth * unit(generator) / norm(d))));
    const Vec3 size = set.box.max - set.box.min;
    const Vec3 s = set.box.min + Vec3{size.x * unit(generator), size.y * unit(generator), size.z * unit(generator)};
    if (set.exit(s).depth > 0) CHECK(overlap_after(a, b, s));
  }
}

void sets_of_boxes() {
  std::mt19937 generator(31);
  int tried = 0, proven = 0;
  for (int round = 0; round < rounds(600); ++round) {
    const WholeBoxes boxes_a = random_boxes(generator, 1 + round % 3, 5), boxes_b = random_boxes(generator, 1 + round / 3 % 3, 5);
    const Vec3 t = random_half(generator);
    const Surface a = make_surface(mesh_of(boxes_a), true), b = make_surface(mesh_of(boxes_b), true);
    const Surface moved = make_surface(translate(a.mesh, t), true);
    const MeshRelation relation = overlap_relation(moved, b);
    const bool meets = relation.relation != Relation::separated && relation.relation != Relation::touching;
    CHECK(meets == overlap_after(boxes_a, boxes_b, t));
    if (!meets) continue;
    for (const bool regions_alone : {false, true}) {
      Budget budget;
      const auto overlaps = round % 2 == 0 ? Overlaps::first : Overlaps::thickest;
      const OverlapProof proof = prove_overlap(a, moved, b, t, relation, overlaps, regions_alone, budget);
      ++tried;
      if (proof.set.empty() || !(proof.set.exit(t).depth > 0)) continue;
      ++proven;
      check_set(proof.set, boxes_a, boxes_b, t, generator);
    }
  }
  std::printf("overlaps of boxes: %d of %d proven\n", proven, tried);
  CHECK(proven > tried / 2);
}

// Copies of a box cross copies of another one, each with each.
void many_contacts_are_not_listed() {
  const WholeBoxes boxes_a(500, WholeBox{{0, 0, 0}, {2, 2, 2}}), boxes_b(500, WholeBox{{1, 1, 1}, {3, 3, 3}});
  const Surface a = make_surface(mesh_of(boxes_a), true), b = make_surface(mesh_of(boxes_b), true);
  Budget budget;
  const OverlapProof proof = prove_overlap(a, a, b, {}, overlap_relation(a, b), Overlaps::thickest, false, budget);
  CHECK(proof.set.exit({}).depth > 0);
  CHECK(budget.spent() < 1'000'000'000);
}

}  // namespace

UNIT(overlap_proof) {
  sets_of_boxes();
  many_contacts_are_not_listed();
}
