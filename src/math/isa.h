// The instruction set level that this unit is compiled for (math/levels.h), and the inline namespace of everything that
// depends on it. Without intrinsics, so that a unit that only names functions of its level stays cheap to compile.
#pragma once

// PLIANT_X86_BITS: the widest x86 registers that this unit may use, or 0.
#if defined(PLIANT_LEVEL_IS_generic) || !defined(__x86_64__)
#define PLIANT_LEVEL_ISA isa_generic
#define PLIANT_PART_WIDTH 4
#define PLIANT_X86_BITS 0
#elif defined(__AVX512F__)
#define PLIANT_LEVEL_ISA isa_v4
#define PLIANT_PART_WIDTH 16
#define PLIANT_X86_BITS 512
#elif defined(__AVX2__)
#define PLIANT_LEVEL_ISA isa_v3
#define PLIANT_PART_WIDTH 8
#define PLIANT_X86_BITS 256
#else
#define PLIANT_LEVEL_ISA isa_v2
#define PLIANT_PART_WIDTH 4
#define PLIANT_X86_BITS 128
#endif

// PLIANT_WIDE_WIDTH: lanes of a Wide. By default sixteen, on every machine. A unit that defines PLIANT_ONE_REGISTER
// before its first include gets those of a native vector: an operation is then one instruction, so that long formulas
// compile in a fraction of the time and their values fit the registers. Its names are in a namespace of their own.
#ifdef PLIANT_ONE_REGISTER
#define PLIANT_WIDE_WIDTH PLIANT_PART_WIDTH
#define PLIANT_ISA PLIANT_JOIN(PLIANT_LEVEL_ISA, _register)
#else
#define PLIANT_WIDE_WIDTH 16
#define PLIANT_ISA PLIANT_LEVEL_ISA
#endif
#define PLIANT_JOIN(a, b) PLIANT_JOIN_NAMES(a, b)
#define PLIANT_JOIN_NAMES(a, b) a##b
