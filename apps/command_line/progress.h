// A line that shows the progress of a run on a terminal. If standard error is a pipe or a file, nothing is shown.
#pragma once

#include <chrono>
#include <string>

namespace pliant::command {

/// The progress as text: "frame 17 of 120, 43.1 frames/s, 3 s left"; without a rate if that is not known.
std::string progress_line(int done, int total, double seconds);

class Progress {
 public:
  /// If `wanted` is false or standard error is no terminal, nothing is shown.
  Progress(int total, bool wanted);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows how many frames are done, at most ten times per second.
  void show(int done);

 private:
  using Clock = std::chrono::steady_clock;
  int total_;
  bool visible_;
  Clock::time_point start_, shown_;
};

}  // namespace pliant::command
