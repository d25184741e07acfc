// Standard output that is checked: if `pliant schema > file` fills the disk, that is an error.
#pragma once

#include <string>
#include <vector>

#include "pliant/io.h"

namespace pliant::command {

/// Prints text at once. Throws an Error if it cannot be written.
void print(const std::string& text);

/// Makes one line of a text: control characters become
/// , \t or \xNN, so that any file name fits into an error message.
std::string one_line(const std::string& text);

/// A number with a noun: "1 frame", "2 frames".
std::string counted(std::size_t count, const std::string& noun);

/// True of what a robot description lacks or has in vain, which SceneFile::repairs has beside the repairs of meshes.
bool is_of_robot(const std::string& repair);

/// Prints "repaired: ..." for each repair of a mesh, which then differs from its file, and "doubtful: ..." for each
/// doubt about a robot description.
void print_repairs(const std::vector<std::string>& repairs);

/// Prints "left out: ..." for each fill that leaves out what is solid (SceneFile::left_out).
void print_left_out(const std::vector<std::string>& left_out);

/// Prints what was written, "wrote draped.glb (1.2 MB)": a line for each of one or two files, one line for more. Units
/// are decimal.
void print_written(const std::vector<WrittenFile>& files);

/// Throws an Error if a file of `written` is also in `read`, directly or by a link, or occurs twice: outputs must not
/// overwrite inputs or each other.
void refuse_same_file_twice(const std::vector<std::string>& read, const std::vector<std::string>& written);

/// Throws an Error if no file can be written at this path, because of what is there or because of the folder's
/// permissions. Changes nothing. A missing folder that can be made is no error.
void refuse_unwritable(const std::string& path);

/// Makes the missing folders of a path. If that fails, throws an Error that names the path.
void make_folder_of(const std::string& path);

}  // namespace pliant::command
