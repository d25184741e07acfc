// Reads a whole file into memory, for every reader of this folder.
//
// Readers parse memory, never a stream. So a parser can check each claim of a header against the remaining bytes before it
// allocates, and it can be fuzzed without a disk.
#pragma once

#include <cstdint>
#include <string>

namespace pliant {

/// The largest file that a reader accepts, in bytes. It exceeds any triangle
/// mesh that can be simulated, and is small enough for any machine's memory.
inline constexpr std::uint64_t largest_file = std::uint64_t{1} << 30;

/// What to do with a file above the size limit.
enum class AtMost { refuse, first_bytes };

/// Returns the bytes of a regular file; follows symbolic links. Throws an Error that names the path if it is missing, a
/// folder, pipe or device, not readable, or larger than `most` bytes. `first_bytes` truncates to `most` instead.
std::string read_file_bytes(const std::string& path, std::uint64_t most = largest_file, AtMost at_most = AtMost::refuse);

}  // namespace pliant
