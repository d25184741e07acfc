#include "matter/spare_particles.h"

#include <string>

#include "pliant/error.h"

namespace pliant {

void add_spare(int capacity, Object& object) {
  constexpr int most = 1 << 26;
  const auto start = static_cast<int>(object.positions.size());
  object.flow.spare = 0;
  if (capacity == 0) return;
  if (capacity < start || capacity > most)
    throw Error({.object = object.name, .element = "capacity"},
                "is " + std::to_string(capacity) + ", with " + std::to_string(start) + " particles at the start",
                "give those at the start and those that may be emitted, up to 2^26");
  object.flow.spare = capacity - start;
  const Vec3f at = !object.flow.emitters.empty() ? object.flow.emitters.front().position
                   : start > 0                   ? object.positions.front()
                                                 : Vec3f{};
  object.positions.resize(static_cast<std::size_t>(capacity), at);
}

}  // namespace pliant
