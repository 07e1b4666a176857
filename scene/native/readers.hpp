// Strict readers: the bytes of one file in, the mesh or the first defect out. Nothing is repaired silently.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

#include "read_result.hpp"

namespace satcheck::scene {

// Wavefront OBJ. Every `f` of the file; colours, texture coordinates, normals, lines and points are not geometry here.
ReadOutcome read_obj(std::string_view bytes);

// Binary STL (recognised by its size, 84 + 50 n) or ASCII STL; corners of the same coordinates, bit for bit, are one vertex.
ReadOutcome read_stl(std::string_view bytes);

// The next bytes of a file: as many as there is room for, fewer at its end. What it throws goes through a reader.
using NextBytes = std::function<std::size_t(std::span<char> room)>;

// A file of so many bytes that read_stl() takes for binary STL, a piece at a time: the pieces stay in the cache, and no
// memory is fetched for all of it.
ReadOutcome read_binary_stl(std::size_t size, const NextBytes& next);

// PLY 1.0: ascii, binary_little_endian, binary_big_endian.
ReadOutcome read_ply(std::string_view bytes);

// Object File Format, ASCII, optionally with per-vertex normals, colours and texture coordinates.
ReadOutcome read_off(std::string_view bytes);

}  // namespace satcheck::scene
