// Timings and stopwatches, shared by all backends.
#include "parallel/executor.h"

#include <chrono>
#include <cstring>

namespace pliant {

namespace {

long long nanoseconds() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void Timings::add(const char* name, double milliseconds) {
  for (Entry& entry : entries_) {
    if (entry.name == name || std::strcmp(entry.name, name) == 0) {
      entry.milliseconds += milliseconds;
      return;
    }
  }
  entries_.push_back({name, milliseconds});
}

void Timings::clear() {
  for (Entry& entry : entries_) entry.milliseconds = 0;
}

Stopwatch::Stopwatch(Timings& timings, const char* name) : timings_(timings), name_(name), start_(nanoseconds()) {}
Stopwatch::~Stopwatch() { timings_.add(name_, static_cast<double>(nanoseconds() - start_) * 1e-6); }

}  // namespace pliant
