// The steps that a query spends, each about a nanosecond, and its progress. The code counts steps and does not use a
// clock, so the same query has the same count on every machine. The query makes its budget and hands it to all that it
// calls. What is made once and kept, as the closing of a surface, is charged to nobody: asked again, a query costs the
// same.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>

namespace satcheck {

struct SearchState {
  double lower, upper;  // the interval that is proven so far
  std::uint64_t work;   // the steps spent
};

// May be empty. An exception that it throws ends the search.
using Poll = std::function<void(const SearchState&)>;

class Budget {
 public:
  Budget() = default;  // without an end
  explicit Budget(std::uint64_t end, Poll poll = {}) : end_(end), poll_(std::move(poll)) {}

  void spend(std::uint64_t steps) { spent_ += steps; }
  std::uint64_t spent() const { return spent_; }
  std::uint64_t left() const { return end_ - std::min(end_, spent_); }
  bool is_spent() const { return spent_ >= end_; }
  // The steps in all, at most.
  void end_at(std::uint64_t end) { end_ = end; }

  // Whether it is time to tell the progress: every 50,000,000 steps, about twenty times a second.
  bool is_due() const { return poll_ && spent_ >= next_; }
  void tell(double lower, double upper) {
    next_ = spent_ + kPollWork;
    poll_({lower, upper, spent_});
  }

 private:
  static constexpr std::uint64_t kPollWork = 50'000'000;

  std::uint64_t spent_ = 0, end_ = UINT64_MAX, next_ = kPollWork;
  Poll poll_;
};

// Null: nobody pays.
inline void spend(Budget* budget, std::uint64_t steps) {
  if (budget != nullptr) budget->spend(steps);
}

}  // namespace satcheck
