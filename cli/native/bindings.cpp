// JSON values -> text: `satcheck.cli._json`. The only file here that knows Python and nanobind.
#include <nanobind/nanobind.h>

#include <structmember.h>

#include <cmath>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "json_text.hpp"

namespace nb = nanobind;
using namespace satcheck::cli;

namespace {

// Bytes that are usually written at once, and the least size of a piece of a long document.
constexpr std::size_t kUsual = 4096, kPiece = 1 << 16;
constexpr std::size_t kStep = 2;  // blanks that a depth more takes

// How the instances of a msgspec.Struct are written: an object of their fields, or what their to_dict makes.
struct Form {
  struct Field {
    Py_ssize_t offset;  // in bytes, in an instance
    PyObject* name;
    std::string key;  // of the text
    bool said_if_known;
  };
  bool known = false;  // such a class it is
  PyObject* to_dict = nullptr;
  std::vector<Field> fields;
};

// Of a class as the last one says it; nothing of it is let go before the process ends.
Form form_of(nb::handle cls) {
  Form form;
  form.known = nb::hasattr(cls, "__struct_fields__");
  if (!form.known) return form;
  if (nb::hasattr(cls, "to_dict")) {
    form.to_dict = nb::object(cls.attr("to_dict")).release().ptr();
    return form;
  }
  const nb::object optional = nb::getattr(cls, "SAID_IF_KNOWN", nb::make_tuple());
  for (const nb::handle name : cls.attr("__struct_fields__")) {
    const nb::object member = cls.attr(name);
    if (!Py_IS_TYPE(member.ptr(), &PyMemberDescr_Type)) throw nb::type_error("a field without a slot");
    const Py_ssize_t offset = reinterpret_cast<PyMemberDescrObject*>(member.ptr())->d_member->offset;
    std::string key;
    append_string(key, nb::cast<const char*>(name));
    form.fields.push_back({offset, name.inc_ref().ptr(), key + ": ", PySequence_Contains(optional.ptr(), name.ptr()) == 1});
  }
  return form;
}

const Form& known_form(PyTypeObject* cls) {
  static auto* const forms = new std::unordered_map<PyTypeObject*, Form>;
  const auto found = forms->find(cls);
  if (found != forms->end()) return found->second;
  const nb::handle kept = nb::handle(reinterpret_cast<PyObject*>(cls)).inc_ref();
  return forms->emplace(cls, form_of(kept)).first->second;
}

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
  // without: the name of a field of frozen values that is left out, or None.
  explicit Writer(const nb::object& without) {
    PyObject* name = nb::object(without).release().ptr();
    if (PyUnicode_CheckExact(name)) PyUnicode_InternInPlace(&name);  // as the names of fields are
    without_ = nb::steal(name);
    text_.reserve(kUsual);
  }

  // depth: of the object or list that the value is a member of, plus 1.
  void value(PyObject* value, int depth) {
    if (is_scalar(value)) {
      scalar(value);
    } else if (PyDict_Check(value)) {
      object(value, depth);
    } else if (PyList_Check(value) || PyTuple_Check(value)) {
      list(value, depth);
    } else {
      frozen(value, depth);
    }
  }

  // Lone surrogates, which stand for the bytes of a file name that are no UTF-8, stay what they are.
  nb::object text() const {
    return nb::steal(PyUnicode_DecodeUTF8(text_.data(), static_cast<Py_ssize_t>(text_.size()), "surrogatepass"));
  }

  // The same, cut between members of lists.
  nb::list pieces(PyObject* value, int depth) {
    nb::list cut;
    pieces_ = &cut;
    this->value(value, depth);
    cut.append(text());
    pieces_ = nullptr;
    return cut;
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

  void frozen(PyObject* instance, int depth) {
    const Form& form = known_form(Py_TYPE(instance));
    if (!form.known) refuse("value", instance);
    if (form.to_dict != nullptr) {
      const nb::object values = nb::steal(PyObject_CallOneArg(form.to_dict, instance));
      if (!values.is_valid()) throw nb::python_error();
      value(values.ptr(), depth);
      return;
    }
    const Nesting nesting;
    bool first = true;
    for (const Form::Field& field : form.fields) {
      PyObject* const member = *reinterpret_cast<PyObject**>(reinterpret_cast<char*>(instance) + field.offset);
      if (member == nullptr || (field.said_if_known && member == Py_None) || field.name == without_.ptr()) continue;
      text_ += first ? '{' : ',';
      first = false;
      line(depth + 1);
      text_ += field.key;
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
      if (pieces_ != nullptr && text_.size() >= kPiece) {
        pieces_->append(text());
        text_.clear();
      }
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
    } else {
      integer(value);
    }
  }

  void number(PyObject* value) {
    const double number = PyFloat_AsDouble(value);
    if (!std::isfinite(number)) {
      PyErr_Format(PyExc_ValueError, "no JSON form for the number %R", value);
      throw nb::python_error();
    }
    append_number(text_, number + 0.0);  // no negative zero
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

  nb::object without_;
  nb::list* pieces_ = nullptr;
  std::string text_;
};

}  // namespace

NB_MODULE(_json, m) {
  m.doc() = "JSON values -> text, in the one layout that all documents of the command have.";
  m.def(
      "text",
      [](nb::handle value, int depth, const nb::object& without) {
        Writer writer(without);
        writer.value(value.ptr(), depth);
        return writer.text();
      },
      nb::arg("value").none(), nb::arg("depth") = 0, nb::arg("without").none() = nb::none(),
      nb::sig("def text(value: object, depth: int = 0, without: str | None = None) -> str"),
      "The text of a JSON value that stands within `depth` objects and lists, or of a frozen value that stands for one\n"
      "(audit/report/report_values.py); without: the name of a field that is left out.\n\n"
      "Objects and lists of objects take a line per member, plain lists (vectors) one line; numbers have full "
      "precision and no negative zero. TypeError for what is no JSON value, ValueError for a number that is not finite.");
  m.def(
      "pieces",
      [](nb::handle value, int depth, const nb::object& without) { return Writer(without).pieces(value.ptr(), depth); },
      nb::arg("value").none(), nb::arg("depth") = 0, nb::arg("without").none() = nb::none(),
      nb::sig("def pieces(value: object, depth: int = 0, without: str | None = None) -> list[str]"),
      "The same text in pieces, for a document that may be larger than what it is about.");
}
