// A whole file as bytes, for every reader of this folder.
//
// Readers parse memory, never a stream: a parser that is given all there is can check each claim of a header against it
// before it allocates anything, and can be fuzzed without a disk.
#pragma once

#include <cstdint>
#include <string>

namespace pliant {

/// The largest file that a reader takes, in bytes. More than any triangle mesh that can be simulated, less than what would
/// hurt a machine.
inline constexpr std::uint64_t largest_file = std::uint64_t{1} << 30;

/// What is done with a file that is larger than is wanted.
enum class AtMost { refuse, first_bytes };

/// The bytes of a regular file; a symbolic link is followed. Throws Error naming the path where it is missing, a folder, a
/// pipe, a device, not readable, or larger than `most` bytes; with `first_bytes` those up to `most` are given instead.
std::string read_file_bytes(const std::string& path, std::uint64_t most = largest_file, AtMost at_most = AtMost::refuse);

}  // namespace pliant
