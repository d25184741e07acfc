// Runs the program pliant-measure, which holds the subcommands bench, compare and validate.
#pragma once

#include <string>

namespace pliant::command {

/// Replaces this program by pliant-measure from the same folder, with the same arguments. Returns only if that fails:
/// why, and what to do. `subcommand` is the one that is wanted.
std::string replace_by_measure_program(const std::string& subcommand, char** argv);

}  // namespace pliant::command
