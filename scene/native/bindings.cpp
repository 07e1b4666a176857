#include <nanobind/nanobind.h>
NB_MODULE(_readers, m) { (void)m; }
