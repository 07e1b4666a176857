// Strict readers: the bytes of one file in, the mesh or the first defect out. Nothing is repaired silently.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

#include "read_result.hpp"

namespace satcheck::scene {

// Wavefront OBJ: every `f` of the file. Colours, texture coordinates, normals, lines and points are ignored.
ReadOutcome read_obj(std::string_view bytes);

struct Object {
  std::string name;
  MeshData mesh;  // vertices and triangles alone
};

// The objects of an OBJ file that have triangles, in their order; none if only one has faces.
std::vector<Object> split_objects(const MeshData& mesh);

// Binary STL (recognised by its size, 84 + 50 n) or ASCII STL; corners of the same coordinates, bit for bit, are one vertex.
ReadOutcome read_stl(std::string_view bytes);

// Reads the next bytes of a file into `room`; fewer at its end. Readers let its exceptions pass.
using NextBytes = std::function<std::size_t(std::span<char> room)>;

// Reads a file of `size` bytes that is binary STL by the rules of read_stl(), piece by piece. The pieces stay in the
// cache, and no memory for the whole file is needed.
ReadOutcome read_binary_stl(std::size_t size, const NextBytes& next);

// PLY 1.0: ascii, binary_little_endian, binary_big_endian.
ReadOutcome read_ply(std::string_view bytes);

// Object File Format, ASCII, optionally with per-vertex normals, colours and texture coordinates.
ReadOutcome read_off(std::string_view bytes);

// Coordinates alone, one a line; the line of an error is its number from 1.
ReadOutcome read_coordinates(std::string_view bytes);

}  // namespace satcheck::scene
