// The open parts of a search that bounds a part and divides it: the one with the largest key first, and of those with
// the same key the one that was added first.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace satcheck {

// Why a search that narrows an interval ended.
enum class SearchStop : std::uint8_t {
  narrow,      // the interval is as narrow as requested
  decided,     // it is not, but it lies on one side of a limit
  work_spent,  // the work was spent first
};

template <class Part>
class BestFirst {
 public:
  bool empty() const { return heap_.empty(); }
  double key() const { return heap_.front().key; }  // of the first part

  void push(double key, Part part) {
    heap_.push_back({key, next_++, std::move(part)});
    std::push_heap(heap_.begin(), heap_.end());
  }

  Part pop() {
    std::pop_heap(heap_.begin(), heap_.end());
    Part first = std::move(heap_.back().part);
    heap_.pop_back();
    return first;
  }

 private:
  struct Open {
    double key;
    std::uint64_t number;
    Part part;

    bool operator<(const Open& other) const { return key != other.key ? key < other.key : number > other.number; }
  };

  std::vector<Open> heap_;
  std::uint64_t next_ = 0;
};

}  // namespace satcheck
