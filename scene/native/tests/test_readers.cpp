// The readers without Python: what they return, and that no prefix or damage of a file harms them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <random>
#include <span>
#include <string>

#include "readers.hpp"
#include "tests/check.hpp"

namespace {

using namespace satcheck::scene;

using Reader = ReadOutcome (*)(std::string_view);

struct Sample {
  Reader read;
  std::string bytes;
};

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_stl() {
  std::string bytes(80, ' ');
  append<std::uint32_t>(bytes, 2);
  for (int facet = 0; facet < 2; ++facet) {
    for (int i = 0; i < 12; ++i) append(bytes, static_cast<float>((i * i + facet) % 5));
    append<std::uint16_t>(bytes, 0);
  }
  return bytes;
}

std::string binary_ply() {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) append(bytes, value);
  append<std::uint8_t>(bytes, 3);
  for (std::int32_t index : {0, 1, 2}) append(bytes, index);
  return bytes;
}

const Sample samples[] = {
    {read_obj, "v 0 0 0\nv 1 0 0\nv 0 1.25 0\nv 0 0 1e-3\nf 1 2 3\nf -1//2 -2/1/3 \\\n 1 2\n"},
    {read_stl, binary_stl()},
    {read_stl,
     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
     "endfacet\nendsolid\n"},
    {read_ply, binary_ply()},
    {read_ply,
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
     "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    {read_off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    {read_off, "STCnOFF3 3 1\n0 0 0 1 0 0\n1 0\n0\n0 1 0\n3 0 1\n2\n"},
    {read_ply,
     "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nelement tristrips 1\n"
     "property list float int64 vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 3 -1 2 1\n"},
    {read_obj, "f 5 4 3 2 1 6 7\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 1 0\nf 1 2 3 4 5\n"},
    {read_stl,
     "solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 end loop x\nendfacet 1 2\nend solid a\n"},
};

// Every index names a vertex, every coordinate is there: what callers rely on.
bool is_sound(const ReadOutcome& outcome) {
  const MeshData* mesh = std::get_if<MeshData>(&outcome);
  if (!mesh) return !std::get<ReadError>(outcome).code.empty();
  if (mesh->vertices.size() % 3 != 0 || mesh->triangles.size() % 3 != 0) return false;
  for (std::uint32_t index : mesh->triangles) {
    if (index >= mesh->vertices.size() / 3) return false;
  }
  for (double coordinate : mesh->vertices) {
    if (!(coordinate - coordinate == 0)) return false;
  }
  return true;
}

// A copy on the heap of exactly this size, so that a sanitizer sees every byte read beyond it.
ReadOutcome read_exactly(const Sample& sample, std::string_view bytes) {
  const std::vector<char> copy(bytes.begin(), bytes.end());
  return sample.read({copy.data(), copy.size()});
}

void test_samples() {
  for (const Sample& sample : samples) {
    const ReadOutcome outcome = sample.read(sample.bytes);
    CHECK(std::holds_alternative<MeshData>(outcome));
    CHECK(is_sound(outcome));
  }
}

void test_every_prefix() {
  for (const Sample& sample : samples) {
    for (std::size_t size = 0; size <= sample.bytes.size(); ++size) {
      CHECK(is_sound(read_exactly(sample, std::string_view(sample.bytes).substr(0, size))));
    }
  }
}

void test_random_damage() {
  std::mt19937 random(7);
  for (const Sample& sample : samples) {
    for (int round = 0; round < 2000; ++round) {
      std::string bytes = sample.bytes;
      for (int change = 0; change < 3; ++change) bytes[random() % bytes.size()] = static_cast<char>(random());
      CHECK(is_sound(read_exactly(sample, bytes)));
    }
  }
}

const ReadError* error_of(const ReadOutcome& outcome) { return std::get_if<ReadError>(&outcome); }

void test_places() {
  const ReadOutcome zero = read_obj("v 0 0 0\n# a comment \\\nf 0 1 1\nf 0 1 1\n");
  CHECK(error_of(zero) && error_of(zero)->code == code::index_out_of_range);
  CHECK(error_of(zero) && error_of(zero)->line == 3);
  const ReadOutcome cut = read_stl(std::string_view(samples[1].bytes).substr(0, 130));
  CHECK(error_of(cut) && error_of(cut)->code == code::truncated);
  CHECK(error_of(cut) && error_of(cut)->offset == 130);
}

void append_facet(std::string& bytes, std::initializer_list<float> corners) {
  for (int i = 0; i < 3; ++i) append(bytes, 0.f);
  for (float c : corners) append(bytes, c);
  append<std::uint16_t>(bytes, 0);
}

// More vertices than the first table is for.
std::string fan(std::uint32_t facets) {
  std::string bytes(80, ' ');
  append<std::uint32_t>(bytes, facets);
  for (std::uint32_t i = 0; i < facets; ++i) {
    const float x = static_cast<float>(i);
    append_facet(bytes, {x, 1, 0, x + 1, 1, 0, 0, 0, -1});
  }
  return bytes;
}

void test_corners_of_stl_are_vertices_once() {
  constexpr std::uint32_t facets = 1024;
  const ReadOutcome outcome = read_stl(fan(facets));
  const MeshData* mesh = std::get_if<MeshData>(&outcome);
  CHECK(mesh && mesh->vertices.size() == 3 * (facets + 2));
  if (!mesh) return;
  for (std::uint32_t i = 0; i < facets; ++i) {
    const auto at = [&](std::uint32_t corner) { return mesh->vertices[3 * mesh->triangles[3 * i + corner]]; };
    CHECK(at(0) == i && at(1) == i + 1 && mesh->triangles[3 * i + 2] == 2);
  }
}

void test_infinite_corners_of_stl_have_a_place() {
  std::string bytes = fan(25000);
  for (const std::uint32_t few : {0u, 1u, 15u, 16u, 17u}) CHECK(is_sound(read_stl(fan(few))));
  const float infinite = INFINITY;
  std::memcpy(bytes.data() + 84 + 50 * 24000 + 12 + 16, &infinite, sizeof infinite);
  CHECK(error_of(read_stl(bytes)) && error_of(read_stl(bytes))->offset == 84 + 50 * 24000 + 12 + 16);
}

void test_numbers() {
  const ReadOutcome outcome = read_obj(
      "v 0.1 -1.5e-3 +2\nv 1e-400 0.3333333333333333 .5\nv 5. 1E2 -0\nv 123456789012345678901234567890 0 4e-320\n"
      "f 1 2 3\n");
  const MeshData* mesh = std::get_if<MeshData>(&outcome);
  CHECK(mesh);
  if (!mesh) return;
  const double expected[] = {0.1, -1.5e-3, 2, 0, 0.3333333333333333, 0.5, 5, 100, 0, 123456789012345678901234567890., 0,
                             4e-320};
  for (int i = 0; i < 12; ++i) CHECK(mesh->vertices[static_cast<std::size_t>(i)] == expected[i]);
  CHECK(mesh->decimals == 16);
  CHECK(mesh->significant == 2);
  for (const char* word : {"1e", "1e+", ".", "-", "1.2.3", "0x10", "1_000", "1d3", "--1", "1e5.5", "1e999", "-1e400"}) {
    CHECK(error_of(read_obj("v 0 0 " + std::string(word) + "\n")));
  }
}

}  // namespace

UNIT(readers) {
  test_samples();
  test_every_prefix();
  test_random_damage();
  test_places();
  test_corners_of_stl_are_vertices_once();
  test_infinite_corners_of_stl_have_a_place();
  test_numbers();
}
