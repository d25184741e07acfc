// Numbers as text for the writers: the shortest digits that read back as the same float, whatever the locale.
#pragma once

#include <charconv>
#include <string>
#include <type_traits>

#include "pliant/vec3.h"

namespace pliant::output {

/// Appends a number in the fewest digits that give it back exactly.
template <class Number>
void append(std::string& text, Number number) {
  static_assert(std::is_arithmetic_v<Number>);
  char digits[32];
  const std::to_chars_result end = std::to_chars(digits, digits + sizeof digits, number);
  text.append(digits, end.ptr);
}

/// Appends three numbers with `between` in between.
inline void append(std::string& text, const Vec3f& v, const char* between = " ") {
  append(text, v.x);
  text += between;
  append(text, v.y);
  text += between;
  append(text, v.z);
}

}  // namespace pliant::output
