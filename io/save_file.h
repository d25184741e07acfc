// The file that saves are written to: named, typed blocks between a header and a checksum.
//
//   header    magic (8 bytes), format version u32, content u32, size of the file u64, number of blocks u64
//   block     name (24 bytes, zeros behind it), type u32, bytes an element u32, number of elements u64, the elements, zeros up
//             to a multiple of 8 bytes
//   checksum  SHA-256 of all bytes before it, 32 bytes
//
// Everything is little-endian. A later version may add blocks; a reader refuses those that it does not know.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace pliant::save_file {

inline constexpr std::uint32_t version = 1;

/// What a file is of.
enum class Content : std::uint32_t { state = 1, world = 2 };

/// What the elements of a block are.
enum class Type : std::uint32_t { bytes = 1, int64 = 2, float32 = 3, float64 = 4, record = 5 };

/// A block to be written. The bytes stay the caller's.
struct Block {
  std::string_view name;  ///< at most 24 bytes
  Type type = Type::bytes;
  std::uint32_t element_size = 1;  ///< [bytes]
  std::uint64_t count = 0;
  const void* data = nullptr;
};

/// Writes a file whole or not at all. Throws Error naming the path.
void write(const std::string& path, Content content, const std::vector<Block>& blocks);

/// A file that was checked whole: header, size, checksum, and every block inside it.
class Contents {
 public:
  /// Reads and checks. Throws Error naming the path and the reason.
  Contents(std::string path, Content expected);

  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// A block of that type. Throws Error where there is none, or it is of another type or element size.
  const Block& block(std::string_view name, Type type, std::uint32_t element_size) const;
  /// The bytes of a block of type `bytes`.
  std::string_view text(std::string_view name) const;
  /// Throws Error where a block has a name that is not among these.
  void refuse_unknown(const std::vector<std::string_view>& known) const;

  [[noreturn]] void fail(const std::string& problem, const std::string& advice) const;

 private:
  const Block* find(std::string_view name) const;
  void check_header(Content expected) const;
  void check_size(std::uint64_t size) const;
  void check_sum() const;
  void find_blocks();

  std::string path_, bytes_;
  std::vector<Block> blocks_;
};

}  // namespace pliant::save_file
