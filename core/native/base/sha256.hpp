// SHA-256: NIST FIPS 180-4, "Secure Hash Standard" (2015).
#pragma once

#include <string>
#include <string_view>

namespace satcheck {

// Whether this machine has instructions for it.
bool has_sha256_instructions();

// 64 lower-case hexadecimal digits. instructions: use them, where the machine has them.
std::string sha256(std::string_view bytes, bool instructions = true);

}  // namespace satcheck
