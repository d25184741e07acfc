// The joints of an object in a World: those that are broken, and what is needed to solve the others.
#pragma once

#include <memory>
#include <vector>

namespace pliant {

struct JointForest;

struct ObjectJoints {
  std::vector<int> broken;                    ///< indices in CompiledObject::joints, ascending
  std::vector<std::vector<char>> is_broken;   ///< [pool][16 batch + lane] 1: part of a broken joint; empty: none
  std::vector<std::vector<char>> is_skipped;  ///< likewise, also of joints in `forest`: the stencil driver leaves them out
  std::vector<const char*> skipped;           ///< pointers to the same; null: none of the pool. Empty: none at all
  std::unique_ptr<JointForest> forest;        ///< joints that are solved directly; null: none

  ObjectJoints();
  ~ObjectJoints();
  ObjectJoints(ObjectJoints&&) noexcept;
  ObjectJoints& operator=(ObjectJoints&&) noexcept;
};

}  // namespace pliant
