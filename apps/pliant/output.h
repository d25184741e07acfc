// Standard output that is checked: a full disk behind `pliant schema > file` is an error like any other.
#pragma once

#include <string>

namespace pliant::command {

/// Prints text and flushes it. Throws Error where it could not be written.
void print(const std::string& text);

/// `text` on one line, so that an error is one line whatever a file's name holds: control characters as \n, \t or \xNN.
std::string one_line(const std::string& text);

}  // namespace pliant::command
