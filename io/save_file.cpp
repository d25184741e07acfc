#include "io/save_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/sha256.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"
#include "pliant/error.h"

namespace pliant::save_file {

namespace {

// The first bytes of a file. As in PNG, the high bit and both line ends reveal a transfer that changed bytes.
constexpr std::string_view magic = "\x89PLN\r\n\x1a\n";
constexpr std::uint64_t header_size = 32, block_header_size = 40, checksum_size = 32, name_size = 24, alignment = 8;
/// Limit of what a forged header can make a reader allocate [bytes]; more than any machine's memory today.
constexpr std::uint64_t largest_save = std::uint64_t{1} << 38;

const char* const advice_damaged = "use an earlier file, or simulate again from the start";

std::uint64_t padded(std::uint64_t size) { return (size + alignment - 1) / alignment * alignment; }

/// The checksum as bytes instead of hexadecimal digits.
std::string digest(Sha256& sha) {
  const std::string text = sha.finish();
  const auto value = [](char digit) { return digit <= '9' ? digit - '0' : digit - 'a' + 10; };
  std::string bytes(checksum_size, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<char>(value(text[2 * i]) * 16 + value(text[2 * i + 1]));
  return bytes;
}

template <class T>
T value_at(std::string_view bytes, std::uint64_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

const char* words(Content content) { return content == Content::state ? "a State" : "a World"; }

/// Appends bytes to a sink, and adds them to a checksum. A sink is called with (const void*, size).
template <class Sink>
class Writer {
 public:
  explicit Writer(Sink sink) : sink_(std::move(sink)) {}

  void add(const void* data, std::uint64_t size) {
    if (size == 0) return;
    sha_.add(data, size);
    sink_(data, size);
  }
  template <class T>
  void add_value(const T& value) {
    add(&value, sizeof value);
  }
  void add(const Block& block) {
    char name[name_size] = {};
    std::memcpy(name, block.name.data(), std::min<std::size_t>(block.name.size(), name_size));
    add(name, sizeof name);
    add_value(static_cast<std::uint32_t>(block.type));
    add_value(block.element_size);
    add_value(block.count);
    const std::uint64_t size = block.count * block.element_size;
    add(block.data, size);
    constexpr char zeros[alignment] = {};
    add(zeros, padded(size) - size);
  }
  void finish() {
    const std::string sum = digest(sha_);
    sink_(sum.data(), sum.size());
  }

 private:
  Sink sink_;
  Sha256 sha_;
};

std::uint64_t size_of(const std::vector<Block>& blocks) {
  std::uint64_t size = header_size + checksum_size;
  for (const Block& block : blocks) size += block_header_size + padded(block.count * block.element_size);
  return size;
}

template <class Sink>
void write_to(Sink sink, Content content, const std::vector<Block>& blocks) {
  Writer out(std::move(sink));
  out.add(magic.data(), magic.size());
  out.add_value(version);
  out.add_value(static_cast<std::uint32_t>(content));
  out.add_value(size_of(blocks));
  out.add_value(static_cast<std::uint64_t>(blocks.size()));
  for (const Block& block : blocks) out.add(block);
  out.finish();
}

}  // namespace

void write(const std::string& path, Content content, const std::vector<Block>& blocks) {
  AtomicFile file(path);
  write_to([&](const void* data, std::uint64_t size) { file.write(data, size); }, content, blocks);
  file.commit();
}

std::vector<std::byte> bytes_of(Content content, const std::vector<Block>& blocks) {
  std::vector<std::byte> bytes;
  bytes.reserve(size_of(blocks));
  write_to(
      [&](const void* data, std::uint64_t size) {
        const auto* first = static_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), first, first + size);
      },
      content, blocks);
  return bytes;
}

Contents::Contents(std::string path, Content expected) : path_(std::move(path)) {
  bytes_ = read_file_bytes(path_, header_size, AtMost::first_bytes);
  check_header(expected);
  std::error_code unknown;
  check_size(
      std::filesystem::file_size(path_, unknown));  // check the size before memory is allocated for the whole file
  bytes_ = read_file_bytes(path_, largest_save);
  check_all(expected);  // the header again, because the file may have been replaced meanwhile
}

Contents::Contents(std::string name, std::span<const std::byte> bytes, Content expected)
    : path_(std::move(name)), bytes_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {
  check_all(expected);
}

void Contents::check_all(Content expected) {
  check_header(expected);
  check_size(bytes_.size());
  check_sum();
  find_blocks();
}

void Contents::check_size(std::uint64_t size) const {
  const auto claimed = value_at<std::uint64_t>(bytes_, 16);
  if (claimed != size)
    fail(fmt::format("is incomplete or damaged: its header says {} bytes, it has {}", claimed, size), advice_damaged);
}

void Contents::check_header(Content expected) const {
  if (bytes_.empty()) fail("is empty", advice_damaged);
  const std::string_view bytes = bytes_;
  if (bytes.substr(0, magic.size()) != magic.substr(0, bytes.size()))
    fail("is not a file saved by Pliant",
         "give what Pliant saved: a State, a World, or a file of pliant run --checkpoint");
  if (bytes.size() < header_size)
    fail(fmt::format("is incomplete: it has {} bytes of a header of {}", bytes.size(), header_size), advice_damaged);
  if (const auto found = value_at<std::uint32_t>(bytes, 8); found != version) {
    fail(fmt::format("has format version {}, and this Pliant reads version {}", found, version),
         "use the Pliant that wrote it, or simulate again from the start");
  }
  const auto content = value_at<std::uint32_t>(bytes, 12);
  if (content == static_cast<std::uint32_t>(expected)) return;
  const bool known = content == 1 || content == 2;
  fail(fmt::format("holds {}, not {}", known ? words(static_cast<Content>(content)) : "something unknown",
                   words(expected)),
       expected == Content::state ? "load it as a World" : "load it as a State");
}

void Contents::check_sum() const {
  if (bytes_.size() < header_size + checksum_size) fail("is incomplete", advice_damaged);
  const std::string_view bytes = bytes_;
  Sha256 sha;
  sha.add(bytes.data(), bytes.size() - checksum_size);
  if (digest(sha) != bytes.substr(bytes.size() - checksum_size))
    fail("is damaged: its checksum is not that of its contents", advice_damaged);
}

/// Finds the blocks. Sizes are not trusted: each is compared with the bytes that remain before it is multiplied or
/// added.
void Contents::find_blocks() {
  const std::string_view bytes = std::string_view(bytes_).substr(0, bytes_.size() - checksum_size);
  const auto count = value_at<std::uint64_t>(bytes, 24);
  std::uint64_t at = header_size;
  for (std::uint64_t number = 0; number < count; ++number) {
    const auto broken = [&] {
      fail(fmt::format("is malformed: block {} does not fit into it", number), advice_damaged);
    };
    if (bytes.size() - at < block_header_size) broken();
    Block block;
    block.name = bytes.substr(at, name_size);
    block.name = block.name.substr(0, block.name.find('\0'));
    block.type = static_cast<Type>(value_at<std::uint32_t>(bytes, at + name_size));
    block.element_size = value_at<std::uint32_t>(bytes, at + name_size + 4);
    block.count = value_at<std::uint64_t>(bytes, at + name_size + 8);
    at += block_header_size;
    const std::uint64_t left = bytes.size() - at;
    if (block.element_size == 0 || block.count > left / block.element_size) broken();
    if (padded(block.count * block.element_size) > left || has(block.name)) broken();
    block.data = bytes.data() + at;
    at += padded(block.count * block.element_size);
    blocks_.push_back(block);
  }
  if (at != bytes.size()) fail("is malformed: it has bytes after its last block", advice_damaged);
}

const Block* Contents::find(std::string_view name) const {
  for (const Block& block : blocks_)
    if (block.name == name) return &block;
  return nullptr;
}

const Block& Contents::block(std::string_view name, Type type, std::uint32_t element_size) const {
  const Block* const found = find(name);
  if (found == nullptr) fail(fmt::format("is malformed: it has no block '{}'", name), advice_damaged);
  if (found->type != type || found->element_size != element_size)
    fail(fmt::format("is malformed: its block '{}' is of another type", name), advice_damaged);
  return *found;
}

std::string_view Contents::text(std::string_view name) const {
  const Block& found = block(name, Type::bytes, 1);
  return {static_cast<const char*>(found.data), static_cast<std::size_t>(found.count)};
}

void Contents::refuse_unknown(const std::vector<std::string_view>& known) const {
  for (const Block& block : blocks_) {
    if (std::find(known.begin(), known.end(), block.name) != known.end()) continue;
    fail(fmt::format("has a block '{}', which this Pliant does not know", block.name), "use the Pliant that wrote it");
  }
}

void Contents::fail(const std::string& problem, const std::string& advice) const {
  throw Error({.file = path_, .line = 0, .object = {}, .element = {}}, problem, advice);
}

}  // namespace pliant::save_file
