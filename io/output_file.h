// What writers write to: files on disk, or bytes in memory that go to the caller once they are complete.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "pliant/io.h"

namespace pliant {

/// A file being written: an AtomicFile, or one in memory.
class OutputFile {
 public:
  OutputFile() = default;
  virtual ~OutputFile() = default;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends bytes. Throws an Error that names the path if the write fails.
  virtual void write(const void* bytes, std::size_t count) = 0;
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Appends the bytes of a value as they are in memory (little-endian on every supported machine).
  template <class T>
  void write_value(const T& value) {
    write(&value, sizeof value);
  }

  /// Replaces `count` bytes that were written at `offset` before: for headers that count what follows.
  virtual void overwrite(std::size_t offset, const void* bytes, std::size_t count) = 0;

  /// The number of bytes written so far.
  virtual std::size_t size() const = 0;

  /// Completes the file: gives it its name, or passes it on.
  virtual void commit() = 0;

  virtual const std::string& path() const = 0;
};

namespace output {

/// Where the files of a writer go.
struct Destination {
  std::string path;                        ///< the user's path with suffix
  std::shared_ptr<const FileSink> sink{};  ///< shared by all files, as it may have a state; null: files go to disk

  bool is_disk() const { return sink == nullptr; }
  /// Begins one of the writer's files.
  std::unique_ptr<OutputFile> open(const std::string& file) const;
};

}  // namespace output

}  // namespace pliant
