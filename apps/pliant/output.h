// Standard output that is checked: a full disk behind `pliant schema > file` is an error like any other.
#pragma once

#include <string>
#include <vector>

namespace pliant::command {

/// Prints text and flushes it. Throws Error where it could not be written.
void print(const std::string& text);

/// `text` on one line, so that an error is one line whatever a file's name holds: control characters as \n, \t or \xNN.
std::string one_line(const std::string& text);

/// "mended: ...", a line for each thing that reading a mesh mended: from then on the mesh is another than its file's.
void print_repairs(const std::vector<std::string>& repairs);

/// Throws Error where one of `written` is `read`, a link to it, or there twice: what is written must not replace what was read.
void refuse_same_file_twice(const std::string& read, const std::vector<std::string>& written);

}  // namespace pliant::command
