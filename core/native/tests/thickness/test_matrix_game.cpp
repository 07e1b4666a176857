// Games against their known values.
#include "thickness/matrix_game.hpp"

#include <random>

#include "tests/check.hpp"

using namespace satcheck;

namespace {

using Columns = std::vector<std::vector<double>>;

struct Value {
  double at_most = -1e300, at_least = 1e300;  // what the weights of the columns and of the rows prove
};

Value value_of(const Columns& columns, double floor) {
  MatrixGame game(columns[0].size(), floor, 1);
  for (const auto& column : columns) {
    game.add(column);
    game.solve();
  }
  Value value;
  for (std::size_t r = 0; r < columns[0].size(); ++r) {
    double sum = 0;
    for (std::size_t c = 0; c < columns.size(); ++c) sum += game.column_weights()[c] * columns[c][r];
    value.at_most = std::max(value.at_most, sum);
  }
  for (const auto& column : columns) {
    double sum = 0;
    for (std::size_t r = 0; r < column.size(); ++r) sum += game.row_weights()[r] * column[r];
    value.at_least = std::min(value.at_least, sum);
  }
  return value;
}

}  // namespace

UNIT(matrix_game) {
  const Value pennies = value_of({{1, -1}, {-1, 1}}, -1);
  CHECK(std::fabs(pennies.at_most) < 1e-12 && std::fabs(pennies.at_least) < 1e-12);
  const Value saddle = value_of({{3, 5}, {4, 2}, {1, 0}}, 0);
  CHECK(std::fabs(saddle.at_most - 1) < 1e-12 && std::fabs(saddle.at_least - 1) < 1e-12);

  // Both players prove the same value.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> payment(-1, 1);
  for (int sample = 0; sample < 50; ++sample) {
    Columns columns(12, std::vector<double>(8));
    for (auto& column : columns) {
      for (double& entry : column) entry = payment(random);
    }
    const Value value = value_of(columns, -1);
    CHECK(std::fabs(value.at_most - value.at_least) < 1e-9);
  }
}
