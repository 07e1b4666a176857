// Buffer views of glTF that EXT_meshopt_compression or KHR_meshopt_compression packs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace satcheck::scene {

enum class MeshoptMode { attributes, triangles, indices };

// `count` consecutive elements of `stride` bytes. Throws ReadError if the stream does not contain exactly these.
std::string unpack_meshopt(std::string_view stream, MeshoptMode mode, std::size_t count, std::size_t stride);

// Undo filters of positions and placements, in place. The other filters are for normals and colours.
void undo_exponential_filter(std::string& elements);                      // 32-bit words: float32
void undo_quaternion_filter(std::string& elements);                       // 8 bytes: four normalised int16

}  // namespace satcheck::scene
