// Writes numbers as text for the writers: the fewest digits that read back as the same float, in any locale.
#pragma once

#include <string>

#include "pliant/vec3.h"
#include "shortest_number.h"

namespace pliant::output {

/// Appends a number with the fewest digits that read back exactly.
template <class Number>
void append(std::string& text, Number number) {
  char digits[32];
  text.append(digits, write_shortest(digits, digits + sizeof digits, number));
}

/// Appends the three numbers of a vector with `between` between them.
inline void append(std::string& text, const Vec3f& v, const char* between = " ") {
  append(text, v.x);
  text += between;
  append(text, v.y);
  text += between;
  append(text, v.z);
}

}  // namespace pliant::output
