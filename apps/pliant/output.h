// Standard output that is checked: a full disk behind `pliant schema > file` is an error like any other.
#pragma once

#include <string>
#include <vector>

#include "pliant/io.h"

namespace pliant::command {

/// Prints text and flushes it. Throws Error where it could not be written.
void print(const std::string& text);

/// `text` on one line, so that an error is one line whatever a file's name holds: control characters as \n, \t or \xNN.
std::string one_line(const std::string& text);

/// "1 frame", "2 frames".
std::string counted(std::size_t count, const std::string& noun);

/// "mended: ...", a line for each thing that reading a mesh mended: from then on the mesh is another than its file's.
void print_repairs(const std::vector<std::string>& repairs);

/// "wrote draped.glb (1.2 MB)", a line for each of one or two files, and one line for more; sizes in 1000s. Nothing for none.
void print_written(const std::vector<WrittenFile>& files);

/// Throws Error where one of `written` is one of `read`, a link to it, or there twice: what is written must not replace what was
/// read.
void refuse_same_file_twice(const std::vector<std::string>& read, const std::vector<std::string>& written);

/// Throws Error where no file can be written under this path, for what is there or for the permissions of the folder. Changes
/// nothing: a folder that is missing counts as writable if it can be made.
void refuse_unwritable(const std::string& path);

/// Makes the folder of a file where it is missing, and those above it. Throws Error naming the path.
void make_folder_of(const std::string& path);

}  // namespace pliant::command
