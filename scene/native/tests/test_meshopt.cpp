// The unpacking of meshopt streams without Python: no stream, cut or damaged, harms it.
#include "readers.hpp"

#include <random>
#include <string>
#include <vector>

#include "read_result.hpp"
#include "tests/check.hpp"

namespace {

using namespace satcheck::scene;

struct Stream {
  MeshoptMode mode;
  std::size_t count, stride;
  std::string stream;
};

// Version 0: one group of 16 elements of 4 bytes, of which the first is stored in 4-bit deltas.
const Stream streams[] = {
    {MeshoptMode::attributes, 16, 4,
     std::string("\xa0\x02\x17\x5f\xf0\xbc\x77\xa9\x21\x00\x34\xb5\0\0\0", 15) + std::string(32, '\0')},
    {MeshoptMode::triangles, 6, 4, std::string("\xe1\xf0\x00", 3) + std::string(16, '\0')},
    {MeshoptMode::indices, 3, 2, std::string("\xd1\x00\x04\x08", 4) + std::string(4, '\0')},
};

bool is_sound(const Stream& sample, std::string_view stream) {
  const std::vector<char> copy(stream.begin(), stream.end());  // of this size, so that a sanitizer sees reads beyond it
  try {
    return unpack_meshopt({copy.data(), copy.size()}, sample.mode, sample.count, sample.stride).size() ==
           sample.count * sample.stride;
  } catch (const ReadError& error) {
    return !error.code.empty();
  }
}

}  // namespace

UNIT(meshopt) {
  std::mt19937 random(7);
  for (const Stream& sample : streams) {
    CHECK(unpack_meshopt(sample.stream, sample.mode, sample.count, sample.stride).size() == sample.count * sample.stride);
    for (std::size_t size = 0; size < sample.stream.size(); ++size) {
      CHECK(is_sound(sample, std::string_view(sample.stream).substr(0, size)));
    }
    for (int round = 0; round < 20000; ++round) {
      std::string bytes = sample.stream;
      for (int change = 0; change < 4; ++change) bytes[random() % bytes.size()] = static_cast<char>(random());
      CHECK(is_sound(sample, bytes));
    }
  }
}
