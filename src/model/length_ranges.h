// The distance constraints of a compiled object, in ranges of segments: the tasks of loops that only measure them.
#pragma once

#include <vector>

#include "model/compiled_object.h"

namespace pliant {

/// The ranges of an object, in the order of its segments.
std::vector<LengthRange> find_length_ranges(const CompiledObject& object);

/// Calls body(pool, first, last) for the parts of a range whose segments [first, last) are of one pool of distances
/// with multipliers. PBD stiffness has none.
template <class Body>
void for_lengths(const CompiledObject& object, const LengthRange& range, const Body& body) {
  for (int first = range.first; first < range.last;) {
    const int number = object.segments[first].pool;
    int last = first + 1;
    while (last < range.last && object.segments[last].pool == number) ++last;
    const Pool& pool = object.pools[number];
    if (pool.is_length && pool.law != Law::pbd) body(pool, first, last);
    first = last;
  }
}

}  // namespace pliant
