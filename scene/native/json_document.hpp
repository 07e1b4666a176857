// JSON text -> Python objects. Part of the Python face: not in the library of readers.
#pragma once

#include <nanobind/nanobind.h>

#include <string_view>

namespace satcheck::scene {

struct JsonDocument {
  nanobind::object root;
  bool repeated_keys = false;  // an object has a key twice; the last one counts
};

// What Python's json.loads makes of the text, UTF-8; an invalid root for what is not plain: anything wrong,
// and what is rare enough to leave to json.loads (NaN, integers and nesting without bounds, lone surrogates).
JsonDocument read_json(std::string_view text);

}  // namespace satcheck::scene
