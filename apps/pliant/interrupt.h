// Ctrl-C and other termination signals raise a flag; the frame loop and the step poll it and
// unwind, so that destructors remove all temporary files. If that takes too long, for instance
// while a World is made, the handler removes the temporary files and ends the program.
#pragma once

#include <atomic>
#include <exception>
#include <string>

namespace pliant::command {

/// Thrown after a signal asked the program to end.
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

/// Installs handlers: SIGINT, SIGTERM and SIGHUP raise the flag, and end the program 0.7 s later if it still runs; a second
/// signal ends it at once. A closed pipe becomes a write error instead of a signal.
void catch_signals();

/// True after a signal; long-running work may poll it.
const std::atomic<bool>& interrupted();

/// Throws Interrupted if a signal came.
void throw_if_interrupted();

}  // namespace pliant::command
