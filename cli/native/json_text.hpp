// The JSON text of numbers and strings, as Python's repr and json write them.
#pragma once

#include <string>
#include <string_view>

namespace satcheck::cli {

// The shortest digits that read back as this finite number, in the layout of Python's repr: 1.0, 0.0001, 1e-05, 1e+16.
void append_number(std::string& text, double value);

// In quotes, with the escapes that JSON demands; all other bytes of the UTF-8 as they are.
void append_string(std::string& text, std::string_view utf8);

}  // namespace satcheck::cli
