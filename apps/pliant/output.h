// Checked standard output: a full disk behind `pliant schema > file` is reported as an error.
#pragma once

#include <string>
#include <vector>

#include "pliant/io.h"

namespace pliant::command {

/// Prints and flushes text. Throws an Error if the write fails.
void print(const std::string& text);

/// `text` on one line, with control characters as \n, \t or \xNN, so that any file name fits an error line.
std::string one_line(const std::string& text);

/// "1 frame", "2 frames".
std::string counted(std::size_t count, const std::string& noun);

/// "mended: ...", one line for each repair of a mesh: the mesh then differs from its file.
void print_repairs(const std::vector<std::string>& repairs);

/// "wrote draped.glb (1.2 MB)", a line each for one or two files, one line for more; decimal units. Nothing for no files.
void print_written(const std::vector<WrittenFile>& files);

/// Throws an Error if one of `written` is also in `read`, directly
/// or by a link, or occurs twice: outputs must not overwrite inputs.
void refuse_same_file_twice(const std::vector<std::string>& read, const std::vector<std::string>& written);

/// Throws an Error if no file can be written at this path because of its type or the folder's permissions. Changes nothing:
/// a missing folder counts as writable if it can be created.
void refuse_unwritable(const std::string& path);

/// Creates the missing parent folders of a file. Throws an Error that names the path.
void make_folder_of(const std::string& path);

}  // namespace pliant::command
