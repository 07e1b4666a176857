// A batch says of every pair what check_pair() says, at any number of threads.
#include "convex/batch.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>

#include "tests/check.hpp"
#include "tests/pairs.hpp"

using namespace satcheck;

namespace {

constexpr int kPairs = 2000;  // no whole number of blocks
static_assert(kPairs % kRowsOfALine != 0);

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
bool same(Vec3 a, Vec3 b) { return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z); }
bool same(const PairResult& a, const PairResult& b) {
  return a.outcome == b.outcome && a.reason == b.reason && a.method == b.method && a.feature == b.feature &&
         a.index_a == b.index_a && a.index_b == b.index_b && a.has_distance == b.has_distance &&
         same(a.distance, b.distance) && same(a.lower, b.lower) && same(a.upper, b.upper) &&
         same(a.normal, b.normal) && same(a.witness_a, b.witness_a) && same(a.witness_b, b.witness_b) &&
         a.portal_rounds == b.portal_rounds && a.gjk_iterations == b.gjk_iterations &&
         a.epa_iterations == b.epa_iterations && a.axes_tested == b.axes_tested;
}

void test_every_pair_as_by_itself() {
  testing::Source source(17);
  std::vector<Shape> shapes{make_box({0.5, 0.4, 0.3}), make_sphere(0.5)};
  for (int i = 0; i < 20; ++i) shapes.push_back(make_hull(source.sphere_points(12 + i)));
  std::vector<PairRequest> requests;
  for (int i = 0; i < kPairs; ++i) {
    requests.push_back({&shapes[i % 22], &shapes[(i * 7) % 22], source.pose(0.8), source.pose(0.8)});
  }
  const auto request = [&](std::size_t i) { return requests[i]; };
  for (const Query query : {Query::overlap, Query::depth, Query::distance}) {
    for (const unsigned threads : {1u, 2u, 7u}) {
      const PairResults results = check_pairs(requests.size(), request, query, MethodChoice::automatic, threads);
      CHECK(results.size() == requests.size());
      bool all_same = true;
      for (std::size_t i = 0; i < requests.size(); ++i) {
        const auto& [a, b, pose_a, pose_b] = requests[i];
        all_same = all_same && same(results[i], check_pair(*a, pose_a, *b, pose_b, query));
      }
      CHECK(all_same);
    }
  }
}

template <auto Member>
void check_array(const PairResults& results) {
  const auto* values = results.array<Member>();
  CHECK(reinterpret_cast<std::uintptr_t>(values) % kRowsOfALine == 0);
  bool all_there = true;
  for (std::size_t i = 0; i < results.size(); ++i) all_there = all_there && values[i] == results[i].*Member;
  CHECK(all_there);
}

void test_an_array_a_field() {
  for (const bool measured : {false, true}) {
    PairResults results(kPairs, measured);
    for (int i = 0; i < kPairs; ++i) {
      PairResult result;
      result.outcome = static_cast<Outcome>(i % 4);
      result.axes_tested = i;
      result.distance = i / 2.0;
      result.witness_b = {i / 3.0, i / 5.0, i / 7.0};
      results.set(i, result);
    }
    check_array<&PairResult::outcome>(results);
    check_array<&PairResult::axes_tested>(results);
    if (measured) {
      check_array<&PairResult::distance>(results);
      check_array<&PairResult::witness_b>(results);
      CHECK(results[kPairs - 1].distance == (kPairs - 1) / 2.0);
    } else {
      CHECK(results.array<&PairResult::distance>() == nullptr);
      CHECK(std::isnan(results[kPairs - 1].distance));
    }
    CHECK(results[kPairs - 1].axes_tested == kPairs - 1);
  }
}

void test_the_first_failure_counts() {
  const Shape ball = make_sphere(1);
  for (unsigned threads : {1u, 7u}) {
    std::string said;
    try {
      check_pairs(1000, [&](std::size_t i) -> PairRequest {
        if (i % 300 == 299) throw std::runtime_error(std::to_string(i));
        return {&ball, &ball, {}, {}};
      }, Query::overlap, MethodChoice::automatic, threads);
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
    CHECK(said == "299");
  }
}

}  // namespace

UNIT(batch) {
  test_every_pair_as_by_itself();
  test_an_array_a_field();
  test_the_first_failure_counts();
}
