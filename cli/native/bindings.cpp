// JSON values -> text: `satcheck.cli._json`. The only file here that knows Python and nanobind.
#include <nanobind/nanobind.h>

#include <cmath>
#include <string>
#include <string_view>

#include "json_text.hpp"

namespace nb = nanobind;
using namespace satcheck::cli;

namespace {

// Bytes of what is written at once, as a rule.
constexpr std::size_t kUsual = 4096;
constexpr std::size_t kStep = 2;  // blanks that a depth more takes

// Keeps values that hold themselves from ending the process.
class Nesting {
 public:
  Nesting() {
    if (Py_EnterRecursiveCall(" in a JSON document")) throw nb::python_error();
  }
  ~Nesting() { Py_LeaveRecursiveCall(); }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
};

bool is_scalar(PyObject* value) {
  return PyUnicode_CheckExact(value) || PyFloat_CheckExact(value) || PyLong_CheckExact(value) || PyBool_Check(value) ||
         value == Py_None;
}

class Writer {
 public:
  Writer() { text_.reserve(kUsual); }

  // depth: of the object or list that the value is a member of, plus 1.
  void value(PyObject* value, int depth) {
    if (PyDict_Check(value)) {
      object(value, depth);
    } else if (PyList_Check(value) || PyTuple_Check(value)) {
      list(value, depth);
    } else {
      scalar(value);
    }
  }

  // Lone surrogates, which stand for the bytes of a file name that are no UTF-8, stay what they are.
  nb::object text() const {
    return nb::steal(PyUnicode_DecodeUTF8(text_.data(), static_cast<Py_ssize_t>(text_.size()), "surrogatepass"));
  }

 private:
  void object(PyObject* dict, int depth) {
    const Nesting nesting;
    PyObject *key, *member;
    Py_ssize_t at = 0;
    bool first = true;
    while (PyDict_Next(dict, &at, &key, &member)) {
      text_ += first ? "{" : ",";
      first = false;
      line(depth + 1);
      if (!PyUnicode_Check(key)) refuse("key", key);
      string(key);
      text_ += ": ";
      value(member, depth + 1);
    }
    close(first, "{}", "}", depth);
  }

  void list(PyObject* sequence, int depth) {
    const Nesting nesting;
    const Py_ssize_t count = PySequence_Fast_GET_SIZE(sequence);
    PyObject** members = PySequence_Fast_ITEMS(sequence);
    bool plain = true;
    for (Py_ssize_t k = 0; k < count; ++k) plain = plain && is_scalar(members[k]);
    if (plain) {
      text_ += '[';
      for (Py_ssize_t k = 0; k < count; ++k) {
        if (k > 0) text_ += ", ";
        scalar(members[k]);
      }
      text_ += ']';
      return;
    }
    for (Py_ssize_t k = 0; k < count; ++k) {
      text_ += k > 0 ? "," : "[";
      line(depth + 1);
      value(members[k], depth + 1);
    }
    close(false, "[]", "]", depth);
  }

  void scalar(PyObject* value) {
    if (PyUnicode_CheckExact(value)) {
      string(value);
    } else if (PyFloat_CheckExact(value)) {
      number(value);
    } else if (value == Py_None) {
      text_ += "null";
    } else if (PyBool_Check(value)) {
      text_ += value == Py_True ? "true" : "false";
    } else if (PyLong_CheckExact(value)) {
      integer(value);
    } else {
      refuse("value", value);
    }
  }

  void number(PyObject* value) {
    const double number = PyFloat_AsDouble(value);
    if (!std::isfinite(number)) {
      PyErr_Format(PyExc_ValueError, "no JSON form for the number %R", value);
      throw nb::python_error();
    }
    append_number(text_, number);
  }

  void integer(PyObject* value) {
    int overflow = 0;
    const long long number = PyLong_AsLongLongAndOverflow(value, &overflow);
    if (overflow == 0) {
      text_ += std::to_string(number);
      return;
    }
    const nb::object digits = nb::steal(PyObject_Str(value));
    if (!digits.is_valid()) throw nb::python_error();
    text_ += utf8(digits.ptr());
  }

  void string(PyObject* value) {
    Py_ssize_t size = 0;
    if (const char* bytes = PyUnicode_AsUTF8AndSize(value, &size)) {
      append_string(text_, {bytes, static_cast<std::size_t>(size)});
      return;
    }
    PyErr_Clear();  // a lone surrogate
    const nb::object bytes = nb::steal(PyUnicode_AsEncodedString(value, "utf-8", "surrogatepass"));
    if (!bytes.is_valid()) throw nb::python_error();
    append_string(text_, {PyBytes_AsString(bytes.ptr()), static_cast<std::size_t>(PyBytes_Size(bytes.ptr()))});
  }

  static std::string_view utf8(PyObject* value) {
    Py_ssize_t size = 0;
    const char* bytes = PyUnicode_AsUTF8AndSize(value, &size);
    if (bytes == nullptr) throw nb::python_error();
    return {bytes, static_cast<std::size_t>(size)};
  }

  void close(bool empty, const char* nothing, const char* closing, int depth) {
    if (empty) {
      text_ += nothing;
      return;
    }
    line(depth);
    text_ += closing;
  }

  void line(int depth) {
    text_ += '\n';
    text_.append(kStep * static_cast<std::size_t>(depth), ' ');
  }

  [[noreturn]] static void refuse(const char* what, PyObject* value) {
    PyErr_Format(PyExc_TypeError, "no JSON form for a %s of type %s", what, Py_TYPE(value)->tp_name);
    throw nb::python_error();
  }

  std::string text_;
};

}  // namespace

NB_MODULE(_json, m) {
  m.doc() = "JSON values -> text, in the one layout that all documents of the command have.";
  m.def(
      "text",
      [](nb::handle value, int depth) {
        Writer writer;
        writer.value(value.ptr(), depth);
        return writer.text();
      },
      nb::arg("value").none(), nb::arg("depth") = 0, nb::sig("def text(value: object, depth: int = 0) -> str"),
      "The text of a JSON value that stands within `depth` objects and lists.\n\n"
      "Objects and lists of objects take a line per member, plain lists (vectors) one line; numbers have full "
      "precision. TypeError for what is no JSON value, ValueError for a number that is not finite.");
}
