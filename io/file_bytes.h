// Reads a whole file into memory. Every reader of this folder uses it.
//
// Readers parse memory, never a stream. So a parser can compare each number in a header with the bytes that remain
// before it allocates memory, and can be fuzzed without files.
#pragma once

#include <cstdint>
#include <string>

namespace pliant {

/// Largest file that a reader accepts [bytes]. It exceeds any triangle mesh that can be simulated, and fits any
/// machine's memory.
inline constexpr std::uint64_t largest_file = std::uint64_t{1} << 30;

/// What to do with a file above the size limit.
enum class AtMost { refuse, first_bytes };

/// Returns the bytes of a regular file; follows symbolic links. Throws an Error that names the path if it is missing, a
/// folder, pipe or device, unreadable, or larger than `most` bytes; `first_bytes` cuts a larger file off instead.
std::string read_file_bytes(const std::string& path, std::uint64_t most = largest_file,
                            AtMost at_most = AtMost::refuse);

/// Throws an Error about a file as a whole.
[[noreturn]] void refuse_file(const std::string& path, const std::string& problem, const std::string& advice);

}  // namespace pliant
