// The only exception of the library. It names where, what is wrong and what to do.
#pragma once

#include <stdexcept>
#include <string>

namespace pliant {

/// Where an error is. Every member may be empty; `line` and `column` count from 1, 0 means none.
struct Location {
  std::string file{};     ///< path of a file as the caller gave it
  int line = 0;           ///< line in `file`
  std::string object{};   ///< name of the object in the scene
  std::string element{};  ///< part concerned: "vertex 12", "triangle 7", "/objects/0/mesh" (a JSON path), "byte 84"
  int column = 0;         ///< byte within the line; 0 means none
};

/// Thrown while a scene is built or a file is read or written. World::step never throws.
///
/// what() has the form "FILE:LINE:COLUMN: object 'NAME', ELEMENT: PROBLEM; ADVICE". Parts that are empty are left out.
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
