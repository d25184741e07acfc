// Writes a number with the fewest digits that read back exactly, independent of the locale.
#pragma once

#include <charconv>
#include <type_traits>

#if !defined(__cpp_lib_to_chars)
#include <fmt/format.h>
#endif

namespace pliant {

/// Writes a number into [first, last), which must have room for it. Returns the end of the text.
template <class Number>
char* write_shortest(char* first, char* last, Number number) {
  static_assert(std::is_arithmetic_v<Number>);
#if !defined(__cpp_lib_to_chars)  // libc++ 14 supports integers only
  if constexpr (std::is_floating_point_v<Number>) {
    return fmt::format_to_n(first, last - first, "{}", number).out;
  } else {
    return std::to_chars(first, last, number).ptr;
  }
#else
  return std::to_chars(first, last, number).ptr;
#endif
}

}  // namespace pliant
