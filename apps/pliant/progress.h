// The progress line of a run on a terminal; silent if standard error is a pipe or a file.
#pragma once

#include <chrono>
#include <string>

namespace pliant::command {

/// Progress as text: "frame 17 of 120, 43.1 frames/s, 3 s left". Omits an unknown rate.
std::string progress_line(int done, int total, double seconds);

class Progress {
 public:
  /// Shows nothing unless `wanted` and standard error is a terminal.
  Progress(int total, bool wanted);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Updates at most ten times per second.
  void show(int done);

 private:
  using Clock = std::chrono::steady_clock;
  int total_;
  bool visible_;
  Clock::time_point start_, shown_;
};

}  // namespace pliant::command
