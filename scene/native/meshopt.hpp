// Buffer views of glTF that EXT_meshopt_compression or KHR_meshopt_compression packs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace satcheck::scene {

enum class MeshoptMode { attributes, triangles, indices };

// `count` elements of `stride` bytes each, one after the other. Throws ReadError for a stream that is not exactly that.
std::string unpack_meshopt(std::string_view stream, MeshoptMode mode, std::size_t count, std::size_t stride);

// The filters that positions and placements may have gone through; the others are for normals and colours. In place.
void undo_exponential_filter(std::string& elements);                      // 32-bit words: float32
void undo_quaternion_filter(std::string& elements);                       // 8 bytes: four normalised int16

}  // namespace satcheck::scene
