// Runs work for many worlds on threads of its own, and looks for Ctrl-C meanwhile.
#pragma once

#include <functional>

namespace pliant::python {

/// Calls work(i) for each i in [0, n) on so many threads without the GIL; 0: all of the machine. The caller's thread waits,
/// and lets Python's handlers of signals run every few milliseconds: if one raises, calls `stop`, and throws
/// nb::python_error once all threads have ended. Of exceptions of `work` rethrows that of the smallest i.
void side_by_side(int n, int threads, const std::function<void(int)>& work, const std::function<void()>& stop);

}  // namespace pliant::python
