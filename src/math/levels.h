// The list of instruction set levels of the SIMD units, widest first: X(suffix of function names, name of the level,
// ...).
//
// cmake/PliantLanes.cmake lists the same levels with compiler flags, and says what a new one needs. `generic` names no
// instruction set, so it compiles on any CPU. All levels give the same bits. A build holds some of them
// (PLIANT_LEVELS): "levels/compiled.h" says which; here all are declared.
#pragma once

// clang-format off: one level per line.
#if defined(__x86_64__)
#define PLIANT_FOR_EACH_LEVEL(X, ...) \
  X(v4, "x86-64-v4", __VA_ARGS__)     \
  X(v3, "x86-64-v3", __VA_ARGS__)     \
  X(v2, "x86-64-v2", __VA_ARGS__)     \
  X(generic, "generic", __VA_ARGS__)
#else
#define PLIANT_FOR_EACH_LEVEL(X, ...) X(generic, "generic", __VA_ARGS__)
#endif
// clang-format on

/// Declares `const type& name_v4();` and the like for every level.
#define PLIANT_DECLARE_LEVEL(suffix, isa, type, name) const type& name##_##suffix();
#define PLIANT_DECLARE_LEVELS(type, name) PLIANT_FOR_EACH_LEVEL(PLIANT_DECLARE_LEVEL, type, name)

/// In a SIMD unit, the name of a function for the level that is being compiled, such as `name_v4`.
#define PLIANT_OF_LEVEL(name) PLIANT_JOIN_LEVEL(name, PLIANT_LEVEL)
#define PLIANT_JOIN_LEVEL(name, level) PLIANT_JOIN_LEVEL_NAMES(name, level)
#define PLIANT_JOIN_LEVEL_NAMES(name, level) name##_##level
