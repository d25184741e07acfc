// Ctrl-C and its like: a signal only raises a flag; the frame loop sees it and unwinds, so that every temporary file is
// removed by its own destructor and nothing half-written stays behind.
#pragma once

#include <exception>
#include <string>

namespace pliant::command {

/// Thrown where a signal asked the program to end.
class Interrupted : public std::exception {
 public:
  explicit Interrupted(int signal);
  const char* what() const noexcept override { return message_.c_str(); }
  /// 128 + the signal's number, as a shell reports it.
  int exit_status() const noexcept { return 128 + signal_; }

 private:
  int signal_;
  std::string message_;
};

/// From now on SIGINT, SIGTERM and SIGHUP raise the flag; a second one ends the program at once. A closed pipe becomes an
/// error of the write instead of a signal.
void catch_signals();

/// Throws Interrupted if a signal came.
void throw_if_interrupted();

}  // namespace pliant::command
