// A loop that the compiler unrolls.
#pragma once

/// Put before loops over a stencil's slots. If they are unrolled, their arrays stay in registers; otherwise g++ keeps
/// the records in memory, sets them to zero first and takes 2.5 times as long.
#if defined(__clang__) || defined(__CUDACC__)
#define PLIANT_UNROLL _Pragma("unroll")
#else
#define PLIANT_UNROLL _Pragma("GCC unroll 8")
#endif

/// Put before loops that should not be unrolled: whose body is long, or that run for the last batch of a segment alone.
#if defined(__clang__)
#define PLIANT_KEEP_LOOP _Pragma("clang loop unroll(disable)")
#else
#define PLIANT_KEEP_LOOP _Pragma("GCC unroll 1")
#endif
