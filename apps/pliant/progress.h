// One line on the terminal that says how far a run is; nothing at all where standard error is a pipe or a file.
#pragma once

#include <chrono>
#include <string>

namespace pliant::command {

/// Frames as text: "frame 17 of 120, 43.1 frames/s, 3 s left". A rate that is not known yet is left out.
std::string progress_line(int done, int total, double seconds);

class Progress {
 public:
  /// Shows nothing unless `wanted` and standard error is a terminal.
  Progress(int total, bool wanted);
  ~Progress();  ///< wipes the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// At most ten times a second.
  void show(int done);

 private:
  using Clock = std::chrono::steady_clock;
  int total_;
  bool visible_;
  Clock::time_point start_, shown_;
};

}  // namespace pliant::command
