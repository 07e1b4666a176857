#include "thickness/matrix_game.hpp"

#include <algorithm>
#include <limits>

namespace satcheck {
namespace {

// A basic variable from here on is the slack of a row.
constexpr std::size_t kSlack = std::size_t{1} << 32;
// A column enters the basis where this much is gained, and a row leaves it where it limits the step at all. Entries are
// of the size of 1, so this is far above their rounding.
constexpr double kGain = 1e-12;
constexpr int kPivotsPerRow = 8;

}  // namespace

MatrixGame::MatrixGame(std::size_t rows, double floor, double unit)
    : rows_(rows), floor_(floor), unit_(unit), inverse_(rows * rows, 0.0), basis_(rows),
      basic_(rows, 1.0), prices_(rows, 0.0), step_(rows) {
  for (std::size_t i = 0; i < rows; ++i) {
    inverse_[i * rows + i] = 1;
    basis_[i] = kSlack + i;
  }
}

void MatrixGame::add(std::span<const double> payments) {
  if (unit_ == 0) {
    unit_ = *std::max_element(payments.begin(), payments.end()) - floor_;
    if (!(unit_ > 0)) unit_ = 1;
  }
  // From 1 on: a game without entries of 0 or less has a positive value.
  for (const double payment : payments) columns_.push_back(1 + (payment - floor_) / unit_);
  column_weights_.push_back(0);
}

double MatrixGame::price(std::span<const double> column) const {
  double sum = 0;
  for (std::size_t r = 0; r < rows_; ++r) sum += prices_[r] * column[r];
  return sum;
}

void MatrixGame::solve() {
  const int most = kPivotsPerRow * static_cast<int>(rows_ + column_weights_.size());
  for (int pivots = 0; pivots < most && pivot(); ++pivots) {
  }
  double sum = 0;
  std::fill(column_weights_.begin(), column_weights_.end(), 0.0);
  for (std::size_t r = 0; r < rows_; ++r) {
    if (basis_[r] >= kSlack) continue;
    column_weights_[basis_[r]] = std::max(basic_[r], 0.0);
    sum += column_weights_[basis_[r]];
  }
  for (double& weight : column_weights_) weight /= sum;
  row_weights_.resize(rows_);
  double prices = 0;
  for (std::size_t r = 0; r < rows_; ++r) prices += row_weights_[r] = std::max(prices_[r], 0.0);
  for (double& weight : row_weights_) weight /= prices;
}

bool MatrixGame::is_basic(std::size_t variable) const { return std::find(basis_.begin(), basis_.end(), variable) != basis_.end(); }

bool MatrixGame::pivot() {
  const std::size_t count = column_weights_.size();
  std::size_t best = kSlack + rows_;
  double gain = kGain;
  for (std::size_t c = 0; c < count; ++c) {
    if (is_basic(c)) continue;  // nothing is gained but rounding
    const double reduced = 1 - price({columns_.data() + c * rows_, rows_});
    if (reduced > gain) {
      gain = reduced;
      best = c;
    }
  }
  for (std::size_t r = 0; r < rows_; ++r) {
    if (-prices_[r] > gain && !is_basic(kSlack + r)) {
      gain = -prices_[r];
      best = kSlack + r;
    }
  }
  if (best == kSlack + rows_) return false;
  enter(best, gain);
  return true;
}

void MatrixGame::enter(std::size_t variable, double reduced_cost) {
  for (std::size_t r = 0; r < rows_; ++r) {
    const double* row = inverse_.data() + r * rows_;
    if (variable >= kSlack) {
      step_[r] = row[variable - kSlack];
    } else {
      step_[r] = 0;
      for (std::size_t k = 0; k < rows_; ++k) step_[r] += row[k] * columns_[variable * rows_ + k];
    }
  }
  std::size_t leaving = rows_;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < rows_; ++r) {
    if (step_[r] > kGain && basic_[r] < least * step_[r]) {
      least = basic_[r] / step_[r];
      leaving = r;
    }
  }
  if (leaving == rows_) return;
  double* pivot_row = inverse_.data() + leaving * rows_;
  for (std::size_t k = 0; k < rows_; ++k) pivot_row[k] /= step_[leaving];
  basic_[leaving] = least;
  basis_[leaving] = variable;
  for (std::size_t r = 0; r < rows_; ++r) {
    if (r == leaving) continue;
    for (std::size_t k = 0; k < rows_; ++k) inverse_[r * rows_ + k] -= step_[r] * pivot_row[k];
    basic_[r] -= step_[r] * least;
  }
  for (std::size_t k = 0; k < rows_; ++k) prices_[k] += reduced_cost * pivot_row[k];
}

}  // namespace satcheck
