// Strict readers: the bytes of one file in, the mesh or the first defect out. Nothing is repaired silently. The mesh may be
// empty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

// PLY 1.0: ascii, binary_little_endian, binary_big_endian.
ReadOutcome read_ply(std::string_view bytes);

// Object File Format, ASCII, optionally with per-vertex normals, colours and texture coordinates.
ReadOutcome read_off(std::string_view bytes);

// Coordinates alone, one a line; the line of an error is its number from 1.
ReadOutcome read_coordinates(std::string_view bytes);

// Rows of numbers in a buffer, as accessors of glTF lay them out, little-endian. bytes: from the first number on. code: of
// the type of the numbers, as in Python's `array`: b B h H I f. columns: numbers a row. stride: bytes from row to row, at
// least those of a row; the last row ends with the bytes.
struct Rows {
  std::string_view bytes;
  char code;
  std::size_t columns;
  std::size_t stride;
};

// All numbers, divided by `largest` and not below -1 unless it is 0; nothing if one is not finite.
std::optional<std::vector<double>> as_numbers(const Rows& rows, double largest);

// All numbers, which are unsigned integers.
std::vector<std::uint32_t> as_indices(const Rows& rows);

// Buffer views of glTF that EXT_meshopt_compression or KHR_meshopt_compression packs.
enum class MeshoptMode { attributes, triangles, indices };

// `count` consecutive elements of `stride` bytes. Throws ReadError if the stream does not contain exactly these.
std::string unpack_meshopt(std::string_view stream, MeshoptMode mode, std::size_t count, std::size_t stride);

// Undo filters of positions and placements, in place. The other filters are for normals and colours.
void undo_exponential_filter(std::string& elements);  // 32-bit words: float32
void undo_quaternion_filter(std::string& elements);   // 8 bytes: four normalised int16

}  // namespace satcheck::scene
