// Many convex pairs at once, on all cores, and their results as one array for each field, as numpy reads them.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include "base/large_pages.hpp"
#include "base/parallel.hpp"
#include "convex/narrow_phase.hpp"

namespace satcheck {

template <auto Member>
using Field = std::remove_cvref_t<decltype(std::declval<PairResult>().*Member)>;

// This many rows of the narrowest field, a byte, fill a cache line. Threads that set whole blocks of rows, counted from
// row 0, never write to the same line.
inline constexpr std::size_t kRowsOfALine = 64;

// The fields `Members` of `count` PairResults, as arrays in one block of memory. Each array starts on a cache line.
// Memory is not initialized, so the thread that sets a row touches it first.
template <auto... Members>
class FieldArrays {
  template <auto Member>
  struct Name {};

 public:
  explicit FieldArrays(std::size_t rows)
      : rows_((rows + kRowsOfALine - 1) / kRowsOfALine * kRowsOfALine),
        lines_(unwritten<CacheLine>(rows_ / kRowsOfALine * kRowBytes)) {}

  std::size_t rows() const { return rows_; }

  template <auto Member>
  static constexpr bool holds = (std::is_same_v<Name<Member>, Name<Members>> || ...);

  template <auto Member>
  Field<Member>* array() const {
    auto* bytes = reinterpret_cast<std::byte*>(lines_.get());
    return reinterpret_cast<Field<Member>*>(bytes + rows_ * bytes_before<Member>());
  }
  void set(std::size_t row, const PairResult& result) { ((array<Members>()[row] = result.*Members), ...); }
  void get(std::size_t row, PairResult& result) const { ((result.*Members = array<Members>()[row]), ...); }

 private:
  struct alignas(kRowsOfALine) CacheLine {
    std::byte bytes[kRowsOfALine];
  };
  static constexpr std::size_t kRowBytes = (sizeof(Field<Members>) + ...);

  template <auto Member>
  static constexpr std::size_t bytes_before() {
    std::size_t bytes = 0;
    bool past = false;
    ((past = past || std::is_same_v<Name<Member>, Name<Members>>, bytes += past ? 0 : sizeof(Field<Members>)), ...);
    return bytes;
  }

  std::size_t rows_;
  std::unique_ptr<CacheLine[]> lines_;
};

class PairResults {
 public:
  // Without `measured`, distances and related fields are NaN and need no memory.
  PairResults(std::size_t count, bool measured) : count_(count), measures_(measured ? count : 0), facts_(count) {}

  std::size_t size() const { return count_; }

  void set(std::size_t i, const PairResult& result) {
    facts_.set(i, result);
    if (measures_.rows() > 0) measures_.set(i, result);
  }
  PairResult operator[](std::size_t i) const {
    PairResult result;
    facts_.get(i, result);
    if (measures_.rows() > 0) measures_.get(i, result);
    return result;
  }
  // The array of all pairs; null if nothing was measured.
  template <auto Member>
  const Field<Member>* array() const {
    if constexpr (Facts::holds<Member>) {
      return facts_.array<Member>();
    } else {
      return measures_.rows() > 0 ? measures_.array<Member>() : nullptr;
    }
  }

 private:
  using Measures = FieldArrays<&PairResult::distance, &PairResult::lower, &PairResult::upper, &PairResult::normal,
                               &PairResult::witness_a, &PairResult::witness_b>;
  using Facts = FieldArrays<&PairResult::index_a, &PairResult::index_b, &PairResult::portal_rounds, &PairResult::gjk_iterations,
                            &PairResult::epa_iterations, &PairResult::axes_tested, &PairResult::outcome,
                            &PairResult::reason, &PairResult::method, &PairResult::feature, &PairResult::has_distance>;

  std::size_t count_;
  Measures measures_;
  Facts facts_;
};

struct PairRequest {
  const Shape* a;
  const Shape* b;
  Pose pose_a, pose_b;
};

// check_pair() on request(0), ..., request(count - 1). request(i) is called once, by the thread that needs it. If some
// throw, the exception of the first one is rethrown.
inline PairResults check_pairs(std::size_t count, const std::function<PairRequest(std::size_t)>& request, Query query,
                               MethodChoice method, unsigned threads) {
  PairResults results(count, query != Query::overlap);
  // With blocks of this size the shared counter costs nothing, and they are small enough for an even load.
  parallel_for(count, threads, [&](std::size_t i) {
    const PairRequest r = request(i);
    results.set(i, check_pair(*r.a, r.pose_a, *r.b, r.pose_b, query, method));
  }, kRowsOfALine);
  return results;
}

}  // namespace satcheck
