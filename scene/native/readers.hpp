// Strict readers: the bytes of one file in, the mesh or the first defect out. Nothing is repaired silently.
#pragma once

#include <string_view>

#include "read_result.hpp"

namespace satcheck::scene {

// Wavefront OBJ. Every `f` of the file, polygons as fans from their first vertex; colours, texture
// coordinates, normals, lines and points are not geometry here.
ReadOutcome read_obj(std::string_view bytes);

// Binary STL (recognised by its size, 84 + 50 n) or ASCII STL; corners of the same coordinates, bit for bit, are one vertex.
ReadOutcome read_stl(std::string_view bytes);

// PLY 1.0: ascii, binary_little_endian, binary_big_endian.
ReadOutcome read_ply(std::string_view bytes);

// Object File Format, ASCII, optionally with per-vertex normals, colours and texture coordinates.
ReadOutcome read_off(std::string_view bytes);

}  // namespace satcheck::scene
