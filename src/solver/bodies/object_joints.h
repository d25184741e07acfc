// The joints of an object in a World: those that are broken, and what is needed to solve the others.
#pragma once

#include <utility>
#include <vector>

namespace pliant {

struct JointForest;
struct RodBundle;

struct ObjectJoints {
  std::vector<int> broken;  ///< indices in CompiledObject::joints, ascending
  /// Pairs of bodies that collide because all joints between them are broken; sorted.
  std::vector<std::pair<int, int>> freed;
  std::vector<std::vector<char>> is_broken;  ///< [pool][16 batch + lane] 1: part of a broken joint; empty: none
  std::vector<char> is_asleep;               ///< [body] 1: sleeps, so its constraints are left out; empty: none does
  /// As is_broken, also of joints in `forests` and of bodies that sleep: the stencil driver leaves them out.
  std::vector<std::vector<char>> is_skipped;
  std::vector<const char*> skipped;  ///< pointers to the same; null: none of the pool. Empty: none at all
  std::vector<JointForest> forests;  ///< joints that are solved directly, those of connected bodies in one
  std::vector<RodBundle> bundles;    ///< those of the forests that are rods of equal shape

  ObjectJoints();
  ~ObjectJoints();
  ObjectJoints(ObjectJoints&&) noexcept;
  ObjectJoints& operator=(ObjectJoints&&) noexcept;
};

}  // namespace pliant
