// SIMD kernels of contacts for each instruction set level, and scalar ones with the same bits: the projection of
// contacts between points, and the contacts of points with primitive colliders.
#pragma once

#include "collision/narrow/point_contact.h"
#include "constraints/contact.h"
#include "math/levels.h"
#include "model/pool.h"

namespace pliant {

struct ContactKernels {
  /// Projects contacts[order[i]] for first <= i < last once, as far as they overlap by more than a share `yield` of
  /// their thickness. No two of them may share a dynamic point.
  void (*project)(Contact* contacts, const std::int32_t* order, int first, int last, Record* displacements,
                  float yield);
  /// Makes the contacts of sixteen particles with a primitive collider; null if they are made one at a time
  /// (find_contacts).
  MakePointContacts make_point_contacts;
};

PLIANT_DECLARE_LEVELS(ContactKernels, contact_kernels)
const ContactKernels& contact_kernels_sequential();

}  // namespace pliant
