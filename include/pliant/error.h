// The library's only exception: it states the location, the problem and the remedy.
#pragma once

#include <stdexcept>
#include <string>

namespace pliant {

/// The location of an error. Every member may be empty; `line` counts from 1, 0 means none.
struct Location {
  std::string file{};     ///< path as the caller gave it
  int line = 0;           ///< line in `file`
  std::string object{};   ///< name of the object in the scene
  std::string element{};  ///< the affected part: "vertex 12", "triangle 7", "/objects/0/mesh" (a JSON path), "byte 84"
  int column = 0;         ///< byte of the line, from 1, 0 meaning none
};

/// Thrown while a scene is built or a file is read or written. World::step never throws.
///
/// what() reads "FILE:LINE:COLUMN: object 'NAME', ELEMENT: PROBLEM; ADVICE", without empty parts.
class Error : public std::runtime_error {
 public:
  Error(Location where, std::string problem, std::string advice = {});

  const Location& where() const noexcept { return where_; }
  const std::string& problem() const noexcept { return problem_; }
  const std::string& advice() const noexcept { return advice_; }

 private:
  Location where_;
  std::string problem_, advice_;
};

}  // namespace pliant
