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

Value value_of(const Columns& columns, double floor, double unit = 1) {
  MatrixGame game(columns[0].size(), floor, unit);
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

  // Rows that are the same but for rounding: the weights of the columns still have the sum 1.
  const double low = -0.072299999974727136, high = 2.4180000000229329;
  const Value same = value_of({{low, low, low, low, high, high, high, high},
                               {1.8335318429516918, 1.9564978854634789, 16.950361439731562, 11.547206362807662,
                                0.53649321588918275, 0.5365180878977458, 16.860765986704745, 11.392024899791336}},
                              -27.744, 56.73315);
  CHECK(std::fabs(same.at_most - high) < 1e-9 && std::fabs(same.at_least - high) < 1e-9);

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
