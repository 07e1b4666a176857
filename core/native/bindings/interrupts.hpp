// Python during a long search: its signals, and its progress.
#pragma once

#include <nanobind/nanobind.h>

#include <functional>
#include <utility>

#include "base/budget.hpp"

namespace satcheck {

// Whether a signal ends the work; its exception is then set. Without this, Ctrl-C would take effect only after a long
// search.
inline bool signalled() {
  const nanobind::gil_scoped_acquire held;
  return PyErr_CheckSignals() != 0;
}

inline void raise_interrupts() {
  const nanobind::gil_scoped_acquire held;
  if (signalled()) throw nanobind::python_error();
}

// Of a query that has no interval.
inline void poll_interrupts(const SearchState&) { raise_interrupts(); }

// Called with the interval so far, and with the share of the work that is spent; may be empty.
using Progress = std::function<void(double lower, double upper, double share)>;

// work: of the search, at most.
inline Poll polling(Progress progress, std::uint64_t work) {
  return [progress = std::move(progress), work](const SearchState& state) {
    raise_interrupts();
    if (progress) progress(state.lower, state.upper, static_cast<double>(state.work) / static_cast<double>(work));
  };
}

}  // namespace satcheck
