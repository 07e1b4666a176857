// Signals of Python during a long search.
#pragma once

#include <nanobind/nanobind.h>

namespace satcheck {

// Without this, Ctrl-C would take effect only after a long search.
inline void raise_interrupts() {
  const nanobind::gil_scoped_acquire held;
  if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

}  // namespace satcheck
