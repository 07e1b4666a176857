// The queue of searches: the largest key first, and among equal keys the part that was added first; parts only move.
#include "base/best_first.hpp"

#include <memory>
#include <random>
#include <vector>

#include "tests/check.hpp"

using namespace satcheck;

UNIT(best_first) {
  BestFirst<std::unique_ptr<int>> open;
  CHECK(open.empty());
  std::mt19937 random(1);
  std::vector<double> keys;
  for (int i = 0; i < 500; ++i) {
    keys.push_back(static_cast<double>(random() % 20));
    open.push(keys.back(), std::make_unique<int>(i));
  }
  double last_key = 20;
  int last = -1;
  for (int i = 0; i < 500; ++i) {
    const double key = open.key();
    const int part = *open.pop();
    CHECK(key == keys[static_cast<std::size_t>(part)]);
    CHECK(key < last_key || (key == last_key && part > last));
    last_key = key;
    last = part;
  }
  CHECK(open.empty());
}
