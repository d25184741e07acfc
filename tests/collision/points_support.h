// What tests of points in boxes share.
#pragma once

#include "collision/broad/bounds.h"
#include "pliant/state.h"

namespace pliant::testing_support {

inline bool is_inside(const Record& p, const BoxBounds& box) {
  return p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x && p.y <= box.high.y &&
         p.z <= box.high.z;
}

}  // namespace pliant::testing_support
