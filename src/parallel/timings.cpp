// Timings and stopwatches, shared by all backends.
#include "parallel/executor.h"

#include <chrono>
#include <cstring>

namespace pliant {

namespace {

long long nanoseconds() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
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

void Timings::take(Timings& other) {
  for (const Entry& entry : other.entries_) add(entry.name, entry.milliseconds);
  other.clear();
}

thread_local Timings* Executor::own_timings_ = nullptr;

Stopwatch::Stopwatch(Timings& timings, const char* name)
    : timings_(timings), name_(name), start_(name == nullptr ? 0 : nanoseconds()) {}
Stopwatch::~Stopwatch() {
  if (name_ != nullptr) timings_.add(name_, static_cast<double>(nanoseconds() - start_) * 1e-6);
}

}  // namespace pliant
