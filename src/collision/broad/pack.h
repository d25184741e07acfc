// A pack of bounding volumes, tested against one volume at once: the children of a BVH node.
//
// Axis-aligned boxes are stored by coordinate, so one instruction compares four of them; other volumes are tested in
// sequence. Both give the same bit mask of overlaps.
#pragma once

#include "collision/broad/bounds.h"

namespace pliant {

/// N bounding volumes of any type, tested one after another.
template <Bounds B, int N>
class Pack {
 public:
  B get(int lane) const { return volumes_[lane]; }
  void set(int lane, const B& volume) { volumes_[lane] = volume; }
  /// Returns a volume that encloses the first `count` volumes.
  B merged(int count) const { return B::merged(volumes_, count); }
  /// Bit i is set if volume i, for i < count, overlaps `other`.
  unsigned overlaps(const B& other, int count) const {
    unsigned bits = 0;
    for (int i = 0; i < count; ++i) bits |= static_cast<unsigned>(overlap(volumes_[i], other)) << i;
    return bits;
  }

 private:
  B volumes_[N];
};

/// N axis-aligned boxes, stored by coordinate and tested in groups of four.
template <int N>
requires(N % 4 == 0) class Pack<BoxBounds, N> {
 public:
  BoxBounds get(int lane) const {
    return {{low_[0][lane], low_[1][lane], low_[2][lane]}, {high_[0][lane], high_[1][lane], high_[2][lane]}};
  }
  void set(int lane, const BoxBounds& box) {
    const float low[3] = {box.low.x, box.low.y, box.low.z}, high[3] = {box.high.x, box.high.y, box.high.z};
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis][lane] = low[axis];
      high_[axis][lane] = high[axis];
    }
  }
  BoxBounds merged(int count) const {
    BoxBounds all = get(0);
    for (int i = 1; i < count; ++i) all = {min(all.low, get(i).low), max(all.high, get(i).high)};
    return all;
  }
  unsigned overlaps(const BoxBounds& other, int count) const {
    unsigned bits = 0;
    for (int four = 0; four < N; four += 4) bits |= overlaps_four(other, four) << four;
    return bits & ((1U << count) - 1);
  }

 private:
  using Four = float __attribute__((vector_size(16)));

  static Four load(const float* from) {
    Four four;
    __builtin_memcpy(&four, from, sizeof four);
    return four;
  }
  static Four all(float x) { return Four{x, x, x, x}; }

  unsigned overlaps_four(const BoxBounds& b, int k) const {
    const auto inside = (load(&low_[0][k]) <= all(b.high.x)) & (load(&high_[0][k]) >= all(b.low.x)) &
                        (load(&low_[1][k]) <= all(b.high.y)) & (load(&high_[1][k]) >= all(b.low.y)) &
                        (load(&low_[2][k]) <= all(b.high.z)) & (load(&high_[2][k]) >= all(b.low.z));
#if defined(__SSE2__)
    return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Four>(inside)));
#else
    return static_cast<unsigned>((inside[0] & 1) | (inside[1] & 2) | (inside[2] & 4) | (inside[3] & 8));
#endif
  }

  float low_[3][N] = {}, high_[3][N] = {};
};

}  // namespace pliant
