// Returns memory to the system while a scene is read and a World is made.
#pragma once

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace pliant::command {

/// During its lifetime, large freed arrays return to the system at once, so building adds nothing to a run's memory. Frames
/// reuse the same arrays and are faster without it.
class GiveBackMemory {
 public:
#if defined(__GLIBC__)
  GiveBackMemory() { mallopt(M_MMAP_THRESHOLD, 1 << 18); }
  ~GiveBackMemory() { mallopt(M_MMAP_THRESHOLD, 1 << 25); }  // glibc's own maximum
#else
  GiveBackMemory() {}
  ~GiveBackMemory() {}
#endif
  GiveBackMemory(const GiveBackMemory&) = delete;
  GiveBackMemory& operator=(const GiveBackMemory&) = delete;
};

}  // namespace pliant::command
