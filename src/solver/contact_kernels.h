// The projection of contacts among points: in sixteen lanes for each instruction set, and the scalar twin. All give the same bits.
#pragma once

#include "constraints/contact.h"
#include "math/levels.h"
#include "model/pool.h"

namespace pliant {

struct ContactKernels {
  /// Projects contacts[order[first]] to contacts[order[last - 1]], no two of which share a point that moves.
  void (*project)(Contact* contacts, const std::int32_t* order, int first, int last, Record* displacements);
};

PLIANT_DECLARE_LEVELS(ContactKernels, contact_kernels)
const ContactKernels& contact_kernels_sequential();

}  // namespace pliant
