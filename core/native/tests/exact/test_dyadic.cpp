// Big integers against identities of algebra, with few digits and with more than an object holds itself.
#include "exact/dyadic.hpp"

#include <cmath>
#include <random>
#include <utility>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

std::mt19937 generator(11);

// A sum of numbers whose exponents are `spread` apart at most.
Dyadic random_sum(int terms, int spread) {
  Dyadic sum;
  for (int k = 0; k < terms; ++k) {
    const double mantissa = std::uniform_real_distribution<double>(-1, 1)(generator);
    sum = sum + std::ldexp(mantissa, std::uniform_int_distribution<int>(-spread, spread)(generator));
  }
  return sum;
}

bool equal(const Dyadic& a, const Dyadic& b) { return (a - b).sign() == 0; }

void identities() {
  for (const int spread : {0, 40, 300, 900}) {  // the products have up to 2 * 2 * 900 bits: 113 digits
    for (int round = 0; round < 300; ++round) {
      const Dyadic a = random_sum(6, spread), b = random_sum(6, spread), c = random_sum(6, spread);
      CHECK(equal((a + b) * (a - b), a * a - b * b));
      CHECK(equal((a + b) * c, c * b + c * a));
      CHECK(equal(a - b, -(b - a)));
      CHECK(equal((a + b) - b, a));
      CHECK((a * a + b * b).sign() >= 0 && (a - a).sign() == 0);
      CHECK((a * b).sign() == a.sign() * b.sign());
    }
  }
}

void signs_at_the_edge() {
  const double tiny = std::ldexp(1.0, -1074), huge = std::ldexp(1.0, 1023);
  const Dyadic sum = Dyadic(huge) + tiny;
  CHECK((sum - huge).sign() == 1);
  CHECK((sum - huge - tiny).sign() == 0);
  CHECK((Dyadic(huge) * huge - Dyadic(huge) * huge - Dyadic(tiny) * tiny).sign() == -1);
  CHECK(rounded_ratio(sum * 3.0, sum) == 3.0);
  CHECK((Dyadic(0.0) - 1.0).sign() == -1 && (Dyadic(1.0) - 0.0).sign() == 1);
}

void copies_and_moves_keep_the_value() {
  for (const int spread : {0, 900}) {
    Dyadic value = random_sum(8, spread) * random_sum(8, spread);
    const Dyadic copy = value;
    Dyadic other = random_sum(3, 900 - spread);
    other = copy;
    CHECK(equal(other, value));
    Dyadic taken = std::move(other);
    CHECK(equal(taken, copy));
    std::swap(taken, value);
    CHECK(equal(taken, copy) && equal(value, copy));
  }
}

}  // namespace

UNIT(dyadic) {
  identities();
  signs_at_the_edge();
  copies_and_moves_keep_the_value();
}
