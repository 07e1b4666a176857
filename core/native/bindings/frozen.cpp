// How the values of core/frozen.py are made: what a call gives goes straight to the places of the fields.
#include <nanobind/nanobind.h>
#include <structmember.h>

#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace nb = nanobind;
using namespace nb::literals;

namespace satcheck {
namespace {

// The fields that a call of one class gives, in their order. Offsets are in bytes from the start of an instance.
struct Fields {
  std::vector<Py_ssize_t> offsets;
  std::vector<PyObject*> names, defaults;  // a default is null where the call has to give the field
  std::size_t by_place;                    // so many of them can be given without their names
  bool looks;                              // __post_init__ is called
};

// Kept as long as the process, with the classes themselves.
std::unordered_map<PyObject*, Fields>& known() {
  static auto* const fields = new std::unordered_map<PyObject*, Fields>;
  return *fields;
}

const char* name_of(PyObject* cls) { return reinterpret_cast<PyTypeObject*>(cls)->tp_name; }

PyObject*& place(PyObject* self, Py_ssize_t offset) {
  return *reinterpret_cast<PyObject**>(reinterpret_cast<char*>(self) + offset);
}

// The number of the field, or the number of fields if there is none of this name. guess: where it usually is.
std::size_t find(const Fields& fields, PyObject* name, std::size_t guess) {
  const std::size_t count = fields.names.size();
  if (guess < count && fields.names[guess] == name) return guess;
  for (std::size_t k = 0; k < count; ++k) {
    if (fields.names[k] == name) return k;
  }
  for (std::size_t k = 0; k < count; ++k) {  // a name that is not interned
    if (PyUnicode_Compare(fields.names[k], name) == 0) return k;
  }
  return count;
}

bool fill(PyObject* self, const Fields& fields, PyObject* const* given, std::size_t placed, PyObject* names) {
  PyObject* const cls = reinterpret_cast<PyObject*>(Py_TYPE(self));
  if (placed > fields.by_place) {
    PyErr_Format(PyExc_TypeError, "%s.__init__() takes %zu positional arguments but %zu were given", name_of(cls),
                 fields.by_place, placed);
    return false;
  }
  for (std::size_t k = 0; k < placed; ++k) place(self, fields.offsets[k]) = Py_NewRef(given[k]);
  const Py_ssize_t named = names == nullptr ? 0 : PyTuple_GET_SIZE(names);
  std::size_t next = placed;
  for (Py_ssize_t i = 0; i < named; ++i) {
    PyObject* const name = PyTuple_GET_ITEM(names, i);
    const std::size_t k = find(fields, name, next);
    if (k == fields.names.size()) {
      PyErr_Format(PyExc_TypeError, "%s.__init__() got an unexpected keyword argument %R", name_of(cls), name);
      return false;
    }
    PyObject*& field = place(self, fields.offsets[k]);
    if (field != nullptr) {
      PyErr_Format(PyExc_TypeError, "%s.__init__() got multiple values for argument %R", name_of(cls), name);
      return false;
    }
    field = Py_NewRef(given[placed + static_cast<std::size_t>(i)]);
    next = k + 1;
  }
  for (std::size_t k = placed; k < fields.offsets.size(); ++k) {
    PyObject*& field = place(self, fields.offsets[k]);
    if (field != nullptr) continue;
    if (fields.defaults[k] == nullptr) {
      PyErr_Format(PyExc_TypeError, "%s.__init__() missing a required argument: %R", name_of(cls), fields.names[k]);
      return false;
    }
    field = Py_NewRef(fields.defaults[k]);
  }
  return true;
}

// A call of the class: https://docs.python.org/3/c-api/call.html#the-vectorcall-protocol
PyObject* made(PyObject* cls, PyObject* const* given, std::size_t flags, PyObject* names) {
  const Fields& fields = known().at(cls);
  PyTypeObject* const type = reinterpret_cast<PyTypeObject*>(cls);
  PyObject* const self = type->tp_alloc(type, 0);
  if (self == nullptr) return nullptr;
  if (!fill(self, fields, given, static_cast<std::size_t>(PyVectorcall_NARGS(flags)), names)) {
    Py_DECREF(self);
    return nullptr;
  }
  if (fields.looks) {
    static PyObject* const look = PyUnicode_InternFromString("__post_init__");
    PyObject* const nothing = PyObject_CallMethodNoArgs(self, look);
    if (nothing == nullptr) {
      Py_DECREF(self);
      return nullptr;
    }
    Py_DECREF(nothing);
  }
  return self;
}

void make_by_fields(nb::type_object cls, nb::tuple given, nb::dict defaults, std::size_t by_place) {
  Fields fields{{}, {}, {}, by_place, nb::hasattr(cls, "__post_init__")};
  for (const nb::handle name : given) {
    const nb::object member = cls.attr(name);
    if (!Py_IS_TYPE(member.ptr(), &PyMemberDescr_Type)) throw std::invalid_argument("a field without a slot");
    PyObject* interned = Py_NewRef(name.ptr());
    PyUnicode_InternInPlace(&interned);
    fields.offsets.push_back(reinterpret_cast<PyMemberDescrObject*>(member.ptr())->d_member->offset);
    fields.names.push_back(interned);
    fields.defaults.push_back(defaults.contains(name) ? nb::object(defaults[name]).release().ptr() : nullptr);
  }
  known()[cls.inc_ref().ptr()] = std::move(fields);
  reinterpret_cast<PyTypeObject*>(cls.ptr())->tp_vectorcall = made;
}

}  // namespace

void bind_frozen(nb::module_& m) {
  m.def("make_by_fields", &make_by_fields, "cls"_a, "given"_a, "defaults"_a, "by_place"_a,
        R"(From here on a call of the class makes an instance, and sets its slots, without any __init__ of Python.

given: the names of those that a call sets, in their order; the first by_place of them can do without the name.
defaults: name -> value of those that it can leave out. A __post_init__ is called last. TypeError as Python raises it.)");
}

}  // namespace satcheck
