#include "apps/command_line/progress.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace pliant::command {

namespace {

std::string duration(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

}  // namespace

std::string progress_line(int done, int total, double seconds) {
  std::string line = "frame " + std::to_string(done) + " of " + std::to_string(total);
  if (done <= 0 || !(seconds > 0)) return line;
  const double rate = done / seconds;
  char text[32];
  std::snprintf(text, sizeof text, rate < 10 ? "%.2f" : "%.1f", rate);
  return line + ", " + text + " frames/s, " + duration((total - done) / rate) + " left";
}

Progress::Progress(int total, bool wanted)
    : total_(total), visible_(wanted && isatty(STDERR_FILENO) == 1), start_(Clock::now()), shown_(start_) {}

Progress::~Progress() {
  if (visible_) std::fputs("\r\033[K", stderr);
}

void Progress::show(int done) {
  if (!visible_) return;
  const Clock::time_point now = Clock::now();
  if (now - shown_ < std::chrono::milliseconds(100)) return;
  shown_ = now;
  const std::string line = progress_line(done, total_, std::chrono::duration<double>(now - start_).count());
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
}

}  // namespace pliant::command
