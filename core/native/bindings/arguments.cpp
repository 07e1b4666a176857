#include "bindings/arguments.hpp"

#include <nanobind/stl/array.h>

#include <array>
#include <utility>

namespace nb = nanobind;

namespace satcheck {
namespace {

std::string listed(const std::vector<const char*>& names) {
  std::string text;
  for (const char* name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

std::string text(nb::handle value) { return nb::str(value).c_str(); }

constexpr std::size_t kLongestShown = 60;

// "float32 of shape (4, 2)" of an array, the value where it is short, else its type.
std::string described(nb::handle value) {
  if (nb::hasattr(value, "dtype") && nb::hasattr(value, "shape")) {
    const nb::object dtype = value.attr("dtype"), shape = value.attr("shape");
    const bool is_plain = !nb::hasattr(value, "flags") || nb::cast<bool>(value.attr("flags").attr("c_contiguous"));
    return text(dtype) + " of shape " + text(shape) + (is_plain ? "" : ", not C-contiguous");
  }
  const std::string shown = nb::repr(value).c_str();
  const nb::object name = value.type().attr("__name__");
  return shown.size() <= kLongestShown ? shown : text(name);
}

[[noreturn]] void throw_type_error(const std::string& message) { throw nb::type_error(message.c_str()); }

}  // namespace

Arguments::Arguments(std::string callee, std::initializer_list<const char*> names, const nb::args& args,
                     const nb::kwargs& kwargs)
    : callee_(std::move(callee)), names_(names), values_(names.size()) {
  if (args.size() > names_.size()) {
    throw_type_error(callee_ + "(" + listed(names_) + "): " + std::to_string(args.size()) + " arguments given");
  }
  for (std::size_t i = 0; i < args.size(); ++i) values_[i] = args[i];
  for (const auto& [key, value] : kwargs) {
    const std::string name = text(key);
    std::size_t i = 0;
    while (i < names_.size() && name != names_[i]) ++i;
    if (i == names_.size()) throw_type_error(callee_ + "(" + listed(names_) + "): no argument is named " + name);
    if (values_[i].is_valid()) throw_type_error(callee_ + "(" + listed(names_) + "): " + name + " is given twice");
    values_[i] = nb::borrow(value);
  }
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!values_[i].is_valid()) throw_type_error(callee_ + "(" + listed(names_) + "): " + names_[i] + " is missing");
  }
}

double Arguments::number(std::size_t i) const {
  double value = 0;
  if (!nb::try_cast(values_[i], value)) refuse(i, "a number");
  return value;
}

Vec3 Arguments::three_numbers(std::size_t i) const {
  std::array<double, 3> values{};
  if (!nb::try_cast(values_[i], values)) refuse(i, "three numbers");
  return {values[0], values[1], values[2]};
}

void Arguments::refuse(std::size_t i, const std::string& expected) const {
  throw_type_error(callee_ + ": " + names_[i] + ": " + expected + " expected, got " + described(values_[i]));
}

}  // namespace satcheck
