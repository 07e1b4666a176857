// Signals of Python during a long search.
#pragma once

#include <nanobind/nanobind.h>

namespace satcheck {

// Ctrl-C would not be heard before the end of a long search.
inline void raise_interrupts() {
  const nanobind::gil_scoped_acquire held;
  if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

}  // namespace satcheck
