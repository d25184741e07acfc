// What a program does with an error: one line on standard error, and an exit status.
#pragma once

#include <functional>
#include <string>

namespace pliant::command {

/// Prints "pliant: MESSAGE" as one line on standard error.
void complain(const std::string& message);

/// Calls a subcommand and returns its exit status. Prints an exception as one line; then the status is 1, and after a
/// termination signal 128 + the signal's number.
int run_guarded(const std::function<int()>& subcommand);

}  // namespace pliant::command
