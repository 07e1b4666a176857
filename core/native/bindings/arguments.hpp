// The arguments of a call from Python, by place or by name. An argument that does not fit raises an error in words:
// nanobind alone would list the types of all overloads.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "base/vec.hpp"

namespace satcheck {

class Arguments {
 public:
  // callee: the class or function, for messages. names: of its parameters, which are all required.
  // TypeError for too many arguments, missing ones and unknown names.
  Arguments(std::string callee, std::initializer_list<const char*> names, const nanobind::args& args,
            const nanobind::kwargs& kwargs);

  nanobind::handle operator[](std::size_t i) const { return values_[i]; }

  // ValueError and TypeError name the parameter.
  double number(std::size_t i) const;
  Vec3 three_numbers(std::size_t i) const;

  // TypeError "Hull: points: an (n, 3) array of float64, got int64 of shape (4, 2)".
  [[noreturn]] void refuse(std::size_t i, const std::string& expected) const;

 private:
  std::string callee_;
  std::vector<const char*> names_;
  std::vector<nanobind::object> values_;
};

}  // namespace satcheck
