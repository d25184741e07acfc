// Memory while a scene is read and a World made.
#pragma once

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace pliant::command {

/// While it lives, large arrays that are freed go back to the system at once. What building leaves behind is then no part of what a
/// run takes; frames, which free and take the same arrays again, are faster without.
class GiveBackMemory {
 public:
#if defined(__GLIBC__)
  GiveBackMemory() { mallopt(M_MMAP_THRESHOLD, 1 << 18); }
  ~GiveBackMemory() { mallopt(M_MMAP_THRESHOLD, 1 << 25); }  // the most that glibc itself would come to
#else
  GiveBackMemory() {}
  ~GiveBackMemory() {}
#endif
  GiveBackMemory(const GiveBackMemory&) = delete;
  GiveBackMemory& operator=(const GiveBackMemory&) = delete;
};

}  // namespace pliant::command
