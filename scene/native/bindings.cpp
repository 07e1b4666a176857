// The Python face of the readers: `satcheck._native.readers`. Only it knows nanobind.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <span>
#include <system_error>
#if defined(_WIN32)
#include <io.h>
#else
#include <unistd.h>
#endif

#include "base/large_pages.hpp"
#include "builder.hpp"
#include "polygons.hpp"
#include "readers.hpp"

namespace nb = nanobind;
using namespace satcheck::scene;

namespace {

// The bytes of an array of the mesh, which it keeps alive.
template <class T>
auto view(const std::vector<T>& values, nb::handle owner) {
  static_assert(std::endian::native == std::endian::little, "the arrays are handed over as little-endian bytes");
  return nb::ndarray<nb::memview, const std::uint8_t, nb::ndim<1>>(reinterpret_cast<const std::uint8_t*>(values.data()),
                                                                 {values.size() * sizeof(T)}, owner);
}

template <class T>
nb::bytes to_bytes(const std::vector<T>& values) {
  return nb::bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <ReadOutcome (*Read)(std::string_view)>
ReadOutcome read(const nb::bytes& data) {
  const std::string_view bytes(data.c_str(), data.size());
  nb::gil_scoped_release release;
  return Read(bytes);
}

std::int64_t read_some(int descriptor, char* to, std::size_t most) {
  constexpr std::size_t kMost = 1 << 30;  // that every system takes at once
#if defined(_WIN32)
  return _read(descriptor, to, static_cast<unsigned>(std::min(most, kMost)));
#else
  return ::read(descriptor, to, std::min(most, kMost));
#endif
}

// Reads bytes of an open file into `room`; fewer at the end of the file. Throws std::system_error if it cannot be read.
std::size_t read_up_to(int descriptor, std::span<char> room) {
  std::size_t have = 0;
  while (have < room.size()) {
    const std::int64_t got = read_some(descriptor, room.data() + have, room.size() - have);
    if (got == 0) break;
    if (got > 0) have += static_cast<std::size_t>(got);
    if (got < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category());
  }
  return have;
}

// Up to `size` bytes of an open file; fewer at its end.
nb::bytes read_file(int descriptor, std::size_t size) {
  PyObject* room = PyBytes_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(size));
  if (room == nullptr) nb::raise_python_error();
  char* const bytes = PyBytes_AsString(room);
  std::size_t have = 0;
  try {
    nb::gil_scoped_release release;
    satcheck::prefer_large_pages(bytes, size);
    have = read_up_to(descriptor, {bytes, size});
  } catch (const std::system_error& failure) {
    Py_DECREF(room);
    errno = failure.code().value();
    PyErr_SetFromErrno(PyExc_OSError);
    nb::raise_python_error();
  }
  const nb::bytes whole = nb::steal<nb::bytes>(room);
  return have < size ? nb::bytes(bytes, have) : whole;  // the stable interface has no resize
}

std::variant<nb::bytes, ReadError> unpack_buffer_view(const nb::bytes& stream, const std::string& mode, std::size_t count,
                                                      std::size_t stride, const std::string& filter) {
  const MeshoptMode known = mode == "ATTRIBUTES"  ? MeshoptMode::attributes
                            : mode == "TRIANGLES" ? MeshoptMode::triangles
                                                  : MeshoptMode::indices;
  const std::string_view packed(stream.c_str(), stream.size());
  std::string elements;
  try {
    const nb::gil_scoped_release release;
    elements = unpack_meshopt(packed, known, count, stride);
    if (filter == "EXPONENTIAL") undo_exponential_filter(elements);
    if (filter == "QUATERNION") undo_quaternion_filter(elements);
  } catch (ReadError& error) {
    return std::move(error);
  }
  return nb::bytes(elements.data(), elements.size());
}

Rows rows_of(const nb::bytes& data, const std::string& code, std::size_t columns, std::size_t stride) {
  return {{data.c_str(), data.size()}, code.empty() ? ' ' : code[0], columns, stride};
}

std::optional<nb::bytes> unpack_numbers(const nb::bytes& data, const std::string& code, std::size_t columns,
                                        std::size_t stride, double largest) {
  const auto numbers = as_numbers(rows_of(data, code, columns, stride), largest);
  return numbers ? std::optional(to_bytes(*numbers)) : std::nullopt;
}

std::pair<nb::bytes, std::int64_t> unpack_indices(const nb::bytes& data, const std::string& code, std::size_t stride) {
  const std::vector<std::uint32_t> indices = as_indices(rows_of(data, code, 1, stride));
  const auto largest = std::max_element(indices.begin(), indices.end());
  return std::pair(to_bytes(indices), largest == indices.end() ? -1 : static_cast<std::int64_t>(*largest));
}

template <class T>
std::vector<T> to_vector(const nb::bytes& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::copy_n(bytes.c_str(), values.size() * sizeof(T), reinterpret_cast<char*>(values.data()));
  return values;
}

std::variant<nb::bytes, ReadError> cut_polygons(const nb::bytes& vertices, const nb::bytes& corners, const nb::bytes& lengths) {
  MeshData mesh;
  mesh.vertices = to_vector<double>(vertices);
  const std::vector<std::uint32_t> all = to_vector<std::uint32_t>(corners), counts = to_vector<std::uint32_t>(lengths);
  Polygons polygons;
  std::size_t at = 0;
  try {
    const nb::gil_scoped_release release;
    for (const std::uint32_t length : counts) {
      const std::size_t end = std::min(at + length, all.size());
      const std::vector<std::uint32_t> polygon(all.begin() + static_cast<std::ptrdiff_t>(at),
                                               all.begin() + static_cast<std::ptrdiff_t>(end));
      for (const std::uint32_t corner : polygon) {
        if (corner >= mesh.vertices.size() / 3) fail(code::index_out_of_range, "index out of range: " + std::to_string(corner));
      }
      polygons.add(polygon, nowhere, mesh);
      at = end;
    }
  } catch (ReadError& error) {
    return std::move(error);
  }
  return to_bytes(mesh.triangles);
}

nb::typed<nb::tuple, nb::typed<nb::tuple, nb::str, nb::str>, nb::ellipsis> warnings_of(const MeshData& mesh) {
  nb::list pairs;
  for (const Warning& warning : mesh.warnings) pairs.append(nb::make_tuple(warning.code, warning.message));
  return nb::tuple(pairs);
}

const char* number_format_name(const MeshData& mesh) {
  switch (mesh.number_format) {
    case NumberFormat::written_digits: return "written-digits";
    case NumberFormat::float32: return "float32";
    case NumberFormat::float64: return "float64";
  }
  return "";
}

}  // namespace

namespace satcheck {
void bind_readers(nb::module_& m);
}

void satcheck::bind_readers(nb::module_& m) {
  nb::class_<MeshData>(m, "MeshData", "A mesh as in the file, in file units; all coordinates are finite.")
      .def_prop_ro("vertices", [](nb::handle self) { return view(nb::cast<const MeshData&>(self).vertices, self); },
                   "Little-endian float64 x, y, z of each vertex.")
      .def_prop_ro("triangles", [](nb::handle self) { return view(nb::cast<const MeshData&>(self).triangles, self); },
                   "Little-endian uint32 vertex numbers, three for each triangle.")
      .def_prop_ro("number_format", &number_format_name,
                   nb::sig("def number_format(self) -> typing.Literal['written-digits', 'float32', 'float64']"),
                   "\"written-digits\", \"float32\" or \"float64\".")
      .def_ro("decimals", &MeshData::decimals,
              "Most digits after the point in a coordinate written without an exponent.")
      .def_ro("significant", &MeshData::significant,
              "Most significant digits in a coordinate written with an exponent.")
      .def_ro("rounding", &MeshData::rounding,
              "How far a coordinate may be off that the file stores as an integer: half a unit; else 0.")
      .def_prop_ro("warnings", &warnings_of, "(code, message) of each part of the file that the reader skipped.")
      .def_ro("several_groups", &MeshData::several_groups)
      .def("objects", [](const MeshData& mesh) {
        std::vector<Object> objects;
        {
          const nb::gil_scoped_release release;
          objects = split_objects(mesh);
        }
        std::vector<std::pair<nb::bytes, MeshData>> named;
        for (Object& object : objects) {
          named.emplace_back(nb::bytes(object.name.data(), object.name.size()), std::move(object.mesh));
        }
        return named;
      }, "The objects of an OBJ file, each with its name and its mesh: vertices and triangles alone. None if only one has faces.");

  nb::class_<ReadError>(m, "ReadError", "Why and where a file cannot be used; returned, not raised.")
      .def_ro("code", &ReadError::code)
      .def_ro("message", &ReadError::message)
      .def_ro("line", &ReadError::line, "Line number from 1, or -1.")
      .def_ro("offset", &ReadError::offset, "Byte offset from 0, or -1.");

  m.def("read_obj", &read<read_obj>, nb::arg("data"), "Wavefront OBJ.");
  m.def("read_stl", &read<read_stl>, nb::arg("data"), "Binary or ASCII STL. Corners with equal coordinates, bit for bit, are one vertex.");
  m.def("read_ply", &read<read_ply>, nb::arg("data"), "PLY 1.0, ASCII or binary.");
  m.def("read_off", &read<read_off>, nb::arg("data"), "ASCII OFF.");

  m.def("read_coordinates", &read<read_coordinates>, nb::arg("data"),
        "The vertices of a mesh without triangles, one coordinate a line; the line of an error is the number of the coordinate.");

  m.def("cut_polygons", &cut_polygons, nb::arg("vertices"), nb::arg("corners"), nb::arg("lengths"),
        "The triangles of polygons, as those of OBJ are cut: little-endian float64 vertices, and uint32 corners of one polygon after "
        "the other, `lengths` of them each.");
  m.def("unpack_numbers", &unpack_numbers, nb::arg("data"), nb::arg("code"), nb::arg("columns"), nb::arg("stride"),
        nb::arg("largest"),
        "Rows of numbers, `stride` bytes apart, as little-endian float64; None if one is not finite. code: b, B, h, H, I or f, as of "
        "`array`. largest: the integer that means 1.0; 0: the numbers stand for themselves.");
  m.def("unpack_indices", &unpack_indices, nb::arg("data"), nb::arg("code"), nb::arg("stride"),
        "(unsigned numbers as little-endian uint32, the largest of them or -1).");
  m.def("unpack_meshopt", &unpack_buffer_view, nb::arg("stream"), nb::arg("mode"), nb::arg("count"), nb::arg("stride"),
        nb::arg("filter"),
        "The `count` elements of `stride` bytes of a glTF buffer view that meshopt packed. mode: \"ATTRIBUTES\", \"TRIANGLES\" or "
        "\"INDICES\"; filter: \"NONE\", \"EXPONENTIAL\" or \"QUATERNION\".");

  m.def("read_file", &read_file, nb::arg("descriptor"), nb::arg("size"),
        "Up to `size` bytes of an open file from its current position; OSError if it cannot be read.");
}
