// The compiled module `satcheck._native`. Each room binds what it owns to a submodule.
#include <nanobind/nanobind.h>

namespace satcheck {
void bind_core(nanobind::module_& m);
void bind_readers(nanobind::module_& m);
}

NB_MODULE(_native, m) {
  // Shapes held by a module that lives until the interpreter ends are no leak, and no news for stderr.
  nanobind::set_leak_warnings(false);
  nanobind::module_ core = m.def_submodule("core", "The geometry on arrays.");
  satcheck::bind_core(core);
  nanobind::module_ readers =
      m.def_submodule("readers", "Strict readers for OBJ, STL, PLY and OFF: bytes in, coordinates and vertex numbers out.");
  satcheck::bind_readers(readers);
}
