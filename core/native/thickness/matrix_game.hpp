// A matrix game of few rows: the convex combination of columns whose largest entry is least.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace satcheck {

// One player chooses a column to pay little, the other one a row to receive much; both may mix. Columns are added one
// by one, each solution starts from the last one.
//
// Method: George B. Dantzig's reduction of a game to a linear programme, "A Proof of the Equivalence of the
// Programming Problem and the Game Problem" (1951), by the revised simplex method with a dense inverse. Weights are
// rounded and not proven best: what they prove has to be computed from them.
class MatrixGame {
 public:
  // floor: no payment is smaller than that. unit: the size of their difference from
  // it, 0: that of the first column.
  MatrixGame(std::size_t rows, double floor, double unit = 0);

  void add(std::span<const double> payments);  // one a row
  void solve();

  // Not negative; the sum is 1 up to rounding. Valid after solve(), with one column at least.
  const std::vector<double>& column_weights() const { return column_weights_; }
  const std::vector<double>& row_weights() const { return row_weights_; }

 private:
  bool pivot();
  bool is_basic(std::size_t variable) const;
  void enter(std::size_t variable, double reduced_cost);
  double price(std::span<const double> column) const;

  std::size_t rows_;
  double floor_, unit_;
  std::vector<double> columns_;    // all shifted and scaled columns in a row
  std::vector<double> inverse_;    // rows_ x rows_, of the basis
  std::vector<std::size_t> basis_; // of each row: a column, or a slack from kSlack on
  std::vector<double> basic_;      // values of the basic variables
  std::vector<double> prices_;     // dual values of the rows
  std::vector<double> step_;
  std::vector<double> column_weights_, row_weights_;
};

}  // namespace satcheck
