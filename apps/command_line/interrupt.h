// Ctrl-C and other termination signals set a flag. The frame loop and World::step read it and return, so that
// destructors remove all temporary files. If that takes too long, for instance while a World is made, the signal
// handler removes the temporary files and ends the program.
#pragma once

#include <atomic>
#include <exception>
#include <string>

namespace pliant::command {

/// Thrown when a signal has asked the program to end.
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

/// Installs signal handlers. SIGINT, SIGTERM and SIGHUP set the flag, and end the program 0.7 s later if it still runs;
/// a second signal ends it at once. Writing to a closed pipe becomes an error instead of a signal.
void catch_signals();

/// True after a signal has come. Functions that run long may read it.
const std::atomic<bool>& interrupted();

/// Throws Interrupted if a signal has come.
void throw_if_interrupted();

}  // namespace pliant::command
