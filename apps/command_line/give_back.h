// Returns memory to the system while a scene is read and a World is made.
#pragma once

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace pliant::command {

/// As long as it lives, freed memory of large arrays returns to the system at once, so that making a World does not add
/// to the memory of a run. Frames reuse their arrays and are faster without it.
class GiveBackMemory {
 public:
#if defined(__GLIBC__)
  GiveBackMemory() { mallopt(M_MMAP_THRESHOLD, 1 << 18); }
  ~GiveBackMemory() { mallopt(M_MMAP_THRESHOLD, 1 << 25); }  // the largest threshold that glibc sets by itself
#else
  GiveBackMemory() {}
  ~GiveBackMemory() {}
#endif
  GiveBackMemory(const GiveBackMemory&) = delete;
  GiveBackMemory& operator=(const GiveBackMemory&) = delete;
};

}  // namespace pliant::command
