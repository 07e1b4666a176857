// The progress of a long search.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

namespace satcheck {

struct SearchState {
  double lower, upper;  // the interval that is proven so far
  std::uint64_t work;   // the steps spent
};

using Poll = std::function<void(const SearchState&)>;

// Calls a function every 50,000,000 steps, about twenty times a second. The function may be empty. An exception that it
// throws ends the search.
class Poller {
 public:
  explicit Poller(Poll poll) : poll_(std::move(poll)) {}

  bool is_due(std::uint64_t work) const { return poll_ && work >= next_; }

  void call(const SearchState& state) {
    next_ = state.work + kPollWork;
    poll_(state);
  }

 private:
  static constexpr std::uint64_t kPollWork = 50'000'000;

  Poll poll_;
  std::uint64_t next_ = kPollWork;
};

}  // namespace satcheck
