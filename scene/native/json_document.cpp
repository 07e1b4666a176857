// A recursive descent over the grammar of RFC 8259. Values that are complete wait on a stack for their list.
#include "json_document.hpp"

#include <charconv>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace nb = nanobind;

namespace satcheck::scene {
namespace {

constexpr int kDeepest = 100;
constexpr std::ptrdiff_t kSurelyInt64 = 18;  // digits

bool is_digit(char c) { return c >= '0' && c <= '9'; }

nb::object made(PyObject* object) {
  if (object == nullptr) throw nb::python_error();
  return nb::steal(object);
}

void append_utf8(std::string& text, std::uint32_t code) {
  const auto tail = [&](int shift) { text += static_cast<char>(0x80 | ((code >> shift) & 0x3f)); };
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xc0 | (code >> 6));
    tail(0);
  } else if (code < 0x10000) {
    text += static_cast<char>(0xe0 | (code >> 12));
    tail(6), tail(0);
  } else {
    text += static_cast<char>(0xf0 | (code >> 18));
    tail(12), tail(6), tail(0);
  }
}

// Every method returns an invalid object, or false, for what is not plain.
class Reader {
 public:
  explicit Reader(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  JsonDocument document() {
    nb::object root = value(0);
    skip_space();
    return {at_ == end_ ? std::move(root) : nb::object(), repeated_};
  }

 private:
  nb::object value(int depth) {
    skip_space();
    if (at_ == end_ || depth > kDeepest) return {};
    switch (*at_) {
      case '{': return object(depth);
      case '[': return list(depth);
      case '"': return string() ? text_of(piece_) : nb::object();
      case 't': return word("true", Py_True);
      case 'f': return word("false", Py_False);
      case 'n': return word("null", Py_None);
      default: return number();
    }
  }

  nb::object object(int depth) {
    ++at_;
    nb::object found = made(PyDict_New());
    if (next_is('}')) return found;
    for (Py_ssize_t count = 1;; ++count) {
      skip_space();
      if (at_ == end_ || *at_ != '"' || !string()) return {};
      const nb::object key = key_of(piece_);
      if (!key.is_valid() || !next_is(':')) return {};
      const nb::object member = value(depth + 1);
      if (!member.is_valid()) return {};
      if (PyDict_SetItem(found.ptr(), key.ptr(), member.ptr()) != 0) throw nb::python_error();
      if (PyDict_GET_SIZE(found.ptr()) != count) repeated_ = true, count = PyDict_GET_SIZE(found.ptr());
      if (next_is('}')) return found;
      if (!next_is(',')) return {};
    }
  }

  nb::object list(int depth) {
    ++at_;
    const std::size_t first = waiting_.size();
    if (!next_is(']')) {
      do {
        nb::object item = value(depth + 1);
        if (!item.is_valid()) return {};
        waiting_.push_back(std::move(item));
      } while (next_is(','));
      if (!next_is(']')) return {};
    }
    nb::object found = made(PyList_New(static_cast<Py_ssize_t>(waiting_.size() - first)));
    for (std::size_t k = first; k < waiting_.size(); ++k) {
      PyList_SET_ITEM(found.ptr(), static_cast<Py_ssize_t>(k - first), waiting_[k].release().ptr());
    }
    waiting_.resize(first);
    return found;
  }

  nb::object number() {
    const char* const first = at_;
    if (at_ != end_ && *at_ == '-') ++at_;
    const char* const whole = at_;
    if (!digits() || (*whole == '0' && at_ - whole > 1)) return {};
    bool is_integer = true;
    if (at_ != end_ && *at_ == '.') {
      ++at_;
      is_integer = false;
      if (!digits()) return {};
    }
    if (at_ != end_ && (*at_ == 'e' || *at_ == 'E')) {
      ++at_;
      is_integer = false;
      if (at_ != end_ && (*at_ == '+' || *at_ == '-')) ++at_;
      if (!digits()) return {};
    }
    if (is_integer) {
      if (at_ - whole > kSurelyInt64) return {};
      long long integer = 0;
      std::from_chars(first, at_, integer);
      return made(PyLong_FromLongLong(integer));
    }
    double real = 0;
    if (std::from_chars(first, at_, real).ec != std::errc()) return {};
    return made(PyFloat_FromDouble(real));
  }

  bool digits() {
    const char* const first = at_;
    while (at_ != end_ && is_digit(*at_)) ++at_;
    return at_ != first;
  }

  // Of a string: leaves what it says in piece_.
  bool string() {
    const char* const first = ++at_;
    while (at_ != end_ && *at_ != '"' && *at_ != '\\' && static_cast<unsigned char>(*at_) >= 0x20) ++at_;
    if (at_ == end_) return false;
    if (*at_ == '"') {
      piece_ = {first, static_cast<std::size_t>(at_++ - first)};
      return true;
    }
    unescaped_.assign(first, at_);
    while (at_ != end_ && static_cast<unsigned char>(*at_) >= 0x20) {
      const char c = *at_++;
      if (c == '"') {
        piece_ = unescaped_;
        return true;
      }
      if (c != '\\') {
        unescaped_ += c;
      } else if (!escape()) {
        return false;
      }
    }
    return false;
  }

  bool escape() {
    if (at_ == end_) return false;
    constexpr std::string_view names = "\"\\/bfnrt", meant = "\"\\/\b\f\n\r\t";
    const char c = *at_++;
    if (const std::size_t k = names.find(c); k != names.npos) {
      unescaped_ += meant[k];
      return true;
    }
    std::uint32_t code = 0, low = 0;
    if (c != 'u' || !four_hex(code)) return false;
    if (code >= 0xd800 && code < 0xe000) {  // half of a pair
      if (code >= 0xdc00 || end_ - at_ < 2 || at_[0] != '\\' || at_[1] != 'u') return false;
      at_ += 2;
      if (!four_hex(low) || low < 0xdc00 || low >= 0xe000) return false;
      code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
    }
    append_utf8(unescaped_, code);
    return true;
  }

  bool four_hex(std::uint32_t& code) {
    if (end_ - at_ < 4) return false;
    const char* const last = at_ + 4;
    if (std::from_chars(at_, last, code, 16).ptr != last) return false;
    at_ = last;
    return true;
  }

  // Objects of one list have the same keys: each text is made once.
  nb::object key_of(std::string_view text) {
    const auto known = keys_.find(text);
    if (known != keys_.end()) return known->second;
    nb::object key = text_of(text);
    if (text.data() != unescaped_.data()) keys_.emplace(text, key);
    return key;
  }

  static nb::object text_of(std::string_view text) {
    return made(PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), nullptr));
  }

  nb::object word(std::string_view name, PyObject* meant) {
    if (static_cast<std::size_t>(end_ - at_) < name.size() || std::string_view(at_, name.size()) != name) return {};
    at_ += name.size();
    return nb::borrow(meant);
  }

  bool next_is(char c) {
    skip_space();
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  void skip_space() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
  }

  const char* at_;
  const char* const end_;
  bool repeated_ = false;
  std::string_view piece_;
  std::string unescaped_;
  std::vector<nb::object> waiting_;
  std::unordered_map<std::string_view, nb::object> keys_;
};

}  // namespace

JsonDocument read_json(std::string_view text) { return Reader(text).document(); }

}  // namespace satcheck::scene
