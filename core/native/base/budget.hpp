// The steps that a query spends, each about a nanosecond, and its progress. The code counts steps and does not use a
// clock, so the same query has the same count on every machine. The query makes its budget and hands it to all that it
// calls. What is made once and kept, as the closing of a surface, is charged to nobody: asked again, a query costs the
// same.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

namespace satcheck {

struct SearchState {
  double lower, upper;  // the interval that is proven so far
  std::uint64_t work;   // the steps spent
};

// May be empty. An exception that it throws ends the search.
using Poll = std::function<void(const SearchState&)>;

// Ends a query without an interval in the middle.
struct BudgetSpent : std::runtime_error {
  BudgetSpent() : std::runtime_error("the query takes more steps than it may") {}
};

// The most steps of a query, or of an inspection, unless less is said. About ten seconds.
inline constexpr std::uint64_t kMostSteps = 10'000'000'000;
// For a query that only polls.
inline constexpr std::uint64_t kNoEnd = std::numeric_limits<std::uint64_t>::max();

class Budget {
 public:
  Budget() = default;  // without an end
  explicit Budget(std::uint64_t end, Poll poll = {}) : end_(end), poll_(std::move(poll)) {}

  // For a query that has no interval and so no good place to stop: spend() polls, and throws BudgetSpent at the end.
  static Budget that_stops(std::uint64_t end, Poll poll = {}) {
    Budget budget(end, std::move(poll));
    budget.stop_at_ = std::min(end, kPollWork);
    return budget;
  }

  void spend(std::uint64_t steps) {
    spent_ += steps;
    if (spent_ >= stop_at_) stop();
  }
  std::uint64_t spent() const { return spent_; }
  std::uint64_t left() const { return end_ - std::min(end_, spent_); }
  bool is_spent() const { return spent_ >= end_; }
  // The steps in all, at most.
  void end_at(std::uint64_t end) { end_ = end; }

  // Whether it is time to tell the progress: every 50,000,000 steps, about twenty times a second.
  bool is_due() const { return poll_ && spent_ >= next_; }
  void tell(double lower, double upper) {
    next_ = spent_ + kPollWork;
    note(lower, upper);
    poll_(told_);
  }
  // The interval for those calls of tell_again() that follow.
  void note(double lower, double upper) { told_ = {lower, upper, spent_}; }
  // The interval as it was, during a part of the search that has its own budget, of which it has spent `steps`.
  void tell_again(std::uint64_t steps) const {
    if (poll_) poll_({told_.lower, told_.upper, spent_ + steps});
  }

 private:
  static constexpr std::uint64_t kPollWork = 50'000'000;

  void stop() {
    if (is_spent()) throw BudgetSpent();
    if (poll_) tell(0, std::numeric_limits<double>::infinity());
    stop_at_ = std::min(end_, spent_ + kPollWork);
  }

  std::uint64_t spent_ = 0, end_ = UINT64_MAX, next_ = kPollWork, stop_at_ = UINT64_MAX;
  SearchState told_{0, std::numeric_limits<double>::infinity(), 0};
  Poll poll_;
};

// Null: nobody pays.
inline void spend(Budget* budget, std::uint64_t steps) {
  if (budget != nullptr) budget->spend(steps);
}

}  // namespace satcheck
