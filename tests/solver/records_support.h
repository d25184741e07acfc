// Comparison of records bit by bit.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "pliant/state.h"
#include "support/bits.h"

namespace pliant::testing_support {

inline void expect_same(const Records& a, const Records& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(same_bits(a[i].x, b[i].x) && same_bits(a[i].y, b[i].y) && same_bits(a[i].z, b[i].z) &&
                same_bits(a[i].w, b[i].w))
        << what << ", record " << i << ": " << a[i].x << " " << a[i].y << " " << a[i].z << " " << a[i].w << " and "
        << b[i].x << " " << b[i].y << " " << b[i].z << " " << b[i].w;
  }
}

}  // namespace pliant::testing_support
