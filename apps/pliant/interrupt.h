// Ctrl-C and its like: a signal raises a flag; the frame loop and the step see it and unwind, so that every temporary file is
// removed by its own destructor. Where that takes too long, as while a World is made, the program removes its temporary files
// and ends all the same.
#pragma once

#include <atomic>
#include <exception>
#include <string>

namespace pliant::command {

/// Thrown where a signal asked the program to end.
class Interrupted : public std::exception {
 public:
  explicit Interrupted(int signal);
  const char* what() const noexcept override { return message_.c_str(); }
  /// 128 + the signal's number, as shells report it.
  int exit_status() const noexcept { return 128 + signal_; }

 private:
  int signal_;
  std::string message_;
};

/// From now on SIGINT, SIGTERM and SIGHUP raise the flag, and end the program 0.7 s later if it still runs; a second one ends it
/// at once. A closed pipe becomes an error of the write instead of a signal.
void catch_signals();

/// True after a signal: for whatever can end its work early.
const std::atomic<bool>& interrupted();

/// Throws Interrupted if a signal came.
void throw_if_interrupted();

}  // namespace pliant::command
