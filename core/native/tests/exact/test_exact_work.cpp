// Exact arithmetic counts as work, and more of it where numbers are longer; a sign that float64 can tell counts none.
#include "base/work.hpp"

#include "exact/dyadic.hpp"
#include "exact/predicates.hpp"
#include "tests/check.hpp"

using namespace satcheck;

namespace {

template <class Task>
std::uint64_t work_of(Task task) {
  const std::uint64_t before = work_done;
  task();
  return work_done - before;
}

void test_signs() {
  const Vec3 a{0, 0, 0}, b{1, 0, 0.1}, c{0, 1, 0.3};
  CHECK(work_of([&] { orientation(a, b, c, {0.25, 0.5, 1}); }) == 0);
  CHECK(work_of([&] { orientation(a, b, c, {0.1, 0.7, 0.1 * 0.1 + 0.7 * 0.3}); }) > 100);
}

void test_numbers() {
  const Dyadic third = 1.0 / 3;
  Dyadic longer = third;
  for (int k = 0; k < 6; ++k) longer = longer * longer;
  const std::uint64_t of_short = work_of([&] { third * third; }), of_long = work_of([&] { longer * longer; });
  CHECK(of_short > 0);
  CHECK(of_long > 100 * of_short);
  CHECK(work_of([&] { longer + third; }) > work_of([&] { third + third; }));
}

}  // namespace

UNIT(exact_work) {
  test_signs();
  test_numbers();
}
