// The format of saved files: blocks with name and type, between a header and a checksum.
//
//   header    magic (8 bytes), format version u32, content u32, size of the file u64, number of blocks u64
//   block     name (24 bytes, zero-padded), type u32, bytes per element u32, number of elements u64, the elements, zeros up
//             to a multiple of 8 bytes
//   checksum  SHA-256 of all bytes before it, 32 bytes
//
// Everything is little-endian. A later version may add blocks; a reader rejects unknown ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace pliant::save_file {

inline constexpr std::uint32_t version = 24;

/// What a file contains.
enum class Content : std::uint32_t { state = 1, world = 2 };

/// The type of the elements of a block.
enum class Type : std::uint32_t { bytes = 1, int64 = 2, float32 = 3, float64 = 4, record = 5 };

/// A block to write. Its bytes belong to the caller.
struct Block {
  std::string_view name;  ///< name of the block, at most 24 bytes
  Type type = Type::bytes;
  std::uint32_t element_size = 1;  ///< size of an element [bytes]
  std::uint64_t count = 0;
  const void* data = nullptr;
};

/// Writes a file atomically. If that fails, throws an Error that names the path.
void write(const std::string& path, Content content, const std::vector<Block>& blocks);

/// The bytes of such a file.
std::vector<std::byte> bytes_of(Content content, const std::vector<Block>& blocks);

/// A file that has been read and validated: header, size, checksum and every block.
class Contents {
 public:
  /// Reads and validates a file. Throws an Error that names the path and the reason.
  Contents(std::string path, Content expected);
  /// Validates bytes that are in memory in the same way; `name` stands for the path.
  Contents(std::string name, std::span<const std::byte> bytes, Content expected);

  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// Finds a block. Throws an Error if it is missing, or has another type or element size.
  const Block& block(std::string_view name, Type type, std::uint32_t element_size) const;
  /// The bytes of a block whose type is `bytes`.
  std::string_view text(std::string_view name) const;
  /// Throws an Error if the file has a block whose name is not in `known`.
  void refuse_unknown(const std::vector<std::string_view>& known) const;

  [[noreturn]] void fail(const std::string& problem, const std::string& advice) const;

 private:
  const Block* find(std::string_view name) const;
  void check_all(Content expected);
  void check_header(Content expected) const;
  void check_size(std::uint64_t size) const;
  void check_sum() const;
  void find_blocks();

  std::string path_, bytes_;
  std::vector<Block> blocks_;
};

}  // namespace pliant::save_file
