// Projection of contacts between points: SIMD kernels for each instruction set level, and scalar ones with the same bits.
#pragma once

#include "constraints/contact.h"
#include "math/levels.h"
#include "model/pool.h"

namespace pliant {

struct ContactKernels {
  /// Projects contacts[order[i]] for first <= i < last once. No two of them may share a dynamic point.
  void (*project)(Contact* contacts, const std::int32_t* order, int first, int last, Record* displacements);
};

PLIANT_DECLARE_LEVELS(ContactKernels, contact_kernels)
const ContactKernels& contact_kernels_sequential();

}  // namespace pliant
