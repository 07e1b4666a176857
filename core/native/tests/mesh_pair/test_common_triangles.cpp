// Flush bodies: with their common triangles apart, the facts are those of all pairs of triangles.
#include "mesh_pair/common_triangles.hpp"

#include <random>
#include <utility>

#include "mesh_pair/traversal.hpp"
#include "tests/check.hpp"
#include "tests/shapes.hpp"

using namespace satcheck;

namespace {

Surface joined(const std::vector<Mesh>& parts) {
  Mesh all;
  for (const Mesh& part : parts) testing::append(all, part);
  return make_surface(all, true);
}

Mesh large_box() { return testing::box({-2, -2, -2}, {3, 3, 3}); }

void sphere_in_its_socket() {
  const Mesh sphere = testing::uv_sphere(12);
  const Surface a = joined({sphere}), b = joined({large_box(), testing::reversed(sphere)});
  const SurfaceContacts apart = find_contacts(a, b, AtCrossing::go_on, nullptr, 0);
  CHECK(apart.contacts.empty() && apart.common.size() == 1 && apart.common[0].size() == sphere.triangles.size());
  const PairFacts facts = judge_contact(a, b, apart, Wanted::relation);
  CHECK(facts.relation() == Relation::touching && facts.proven && facts.touch.has_value());
}

// A wall of B ends on the face of A, and another one leaves from an edge of it: neither face may stand for its
// neighbours.
void what_meets_common_triangles_divides_them() {
  const Mesh block = testing::box({0, 0, 0}, {1, 1, 1});
  const Surface a = joined({block});
  const auto regions = [&](Vec3 low, Vec3 high) {
    const Surface b = joined({block, testing::box(low, high)});
    return find_contacts(a, b, AtCrossing::go_on, nullptr, 0).common;
  };
  CHECK(regions({2, 2, 2}, {3, 3, 3}).size() == 1);
  CHECK(regions({2, 2, 2}, {3, 3, 3})[0].size() == 12);
  std::size_t regular = 0;
  for (const auto& region : regions({0.25, 0.25, 1}, {0.5, 0.5, 2})) regular += region.size();
  CHECK(regular == 10);  // the two triangles of the upper face have contact
  regular = 0;
  for (const auto& region : regions({1, 0.25, 0.25}, {2, 0.5, 0.5})) regular += region.size();
  CHECK(regular == 10);
}

void random_solids_of_few_places() {
  std::mt19937 random(1);
  const auto below = [&](int n) { return static_cast<double>(random() % static_cast<unsigned>(n)); };
  int with_regions = 0;
  for (int k = 0; k < testing::rounds(800); ++k) {
    std::vector<Mesh> parts[2];
    for (int body = 0; body < 2; ++body) {
      for (int n = 0; n < 2; ++n) {
        const Vec3 low{below(3), below(3), below(3)}, size{1 + below(2), 1 + below(2), 1 + below(2)};
        parts[body].push_back(testing::box(low, low + size));
      }
    }
    if (below(2) > 0) parts[1] = {large_box()};
    for (const Mesh& part : parts[0]) {
      if (below(4) > 0) parts[1].push_back(below(3) > 0 ? testing::reversed(part) : part);
    }
    const Surface a = joined(parts[0]), b = joined(parts[1]);
    const SurfaceContacts all = find_contacts(a, b, AtCrossing::go_on);
    const SurfaceContacts apart = find_contacts(a, b, AtCrossing::go_on, nullptr, 0);
    with_regions += apart.common.empty() ? 0 : 1;
    CHECK(all.crossing.has_value() == apart.crossing.has_value());
    const PairFacts of_all = judge_contact(a, b, all, Wanted::relation), found = judge_contact(a, b, apart, Wanted::relation);
    CHECK(of_all.relation() == found.relation());
    CHECK((of_all.proven || of_all.settled()) == (found.proven || found.settled()));
  }
  CHECK(with_regions > testing::rounds(800) / 4);
}

}  // namespace

UNIT(common_triangles) {
  sphere_in_its_socket();
  what_meets_common_triangles_divides_them();
  random_solids_of_few_places();
}
