// Loops over the groups of neighbour lists on all threads.
#pragma once

#include <algorithm>

#include "collision/neighbours/neighbour_lists.h"
#include "parallel/executor.h"

namespace pliant {

/// Calls body(group, first slot, last slot) for all groups.
template <class Body>
void for_groups(Executor& executor, const char* name, const NeighbourLists& lists, const Body& body) {
  executor.parallel_for(name, lists.tasks(), [&](int task) {
    const int first = task * NeighbourLists::groups_in_a_task;
    const int last = std::min(first + NeighbourLists::groups_in_a_task, lists.groups());
    for (int group = first; group < last; ++group) {
      const int slot = group * NeighbourLists::lanes;
      body(group, slot, std::min(slot + NeighbourLists::lanes, lists.slots()));
    }
  });
}

}  // namespace pliant
