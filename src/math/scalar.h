// The scalars of pliant/formula.h, and additions that only the library uses.
#pragma once

#include <cstdint>
#include <cstring>

#include "pliant/formula.h"

namespace pliant {

/// What `any` of a mask of lanes is for one.
PLIANT_HD bool any(bool mask) { return mask; }

/// The bits of `from` as a `To` of the same size (std::bit_cast, which not all supported compilers have).
template <class To, class From>
PLIANT_HD To bits_as(const From& from) {
  static_assert(sizeof(To) == sizeof(From), "only between types of one size");
  To to;
#if defined(__CUDA_ARCH__)
  memcpy(&to, &from, sizeof(To));
#else
  std::memcpy(&to, &from, sizeof(To));
#endif
  return to;
}

}  // namespace pliant
