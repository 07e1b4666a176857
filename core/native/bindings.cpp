#include <nanobind/nanobind.h>

namespace satcheck {
void bind_mesh(nanobind::module_& m);
}

NB_MODULE(_native, m) { satcheck::bind_mesh(m); }
