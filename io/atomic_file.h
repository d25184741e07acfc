// Files that are whole or not there: what is written appears under its name only once all of it is on the disk.
//
// A simulation's output takes hours to make and a moment to lose. So every writer of this folder writes to a temporary file
// in the same folder, checks every call, and lets commit() put it in place by one rename, which the file system does wholly
// or not at all. Until then, and for ever where anything fails, the old file stands as it was.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pliant {

/// A file being written. Nothing is seen under `path` before commit() returns.
class AtomicFile {
 public:
  /// Makes the temporary file. A symbolic link is followed; a device or pipe is written to directly. Throws Error naming
  /// the path where its folder is missing, it is itself a folder, or it may not be written.
  explicit AtomicFile(std::string path);

  /// Drops what was written unless commit() has returned.
  ~AtomicFile();

  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes. Throws Error naming the path where the disk is full or the write fails otherwise.
  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Appends a value's bytes as they lie in memory (little-endian on every machine that Pliant is built for).
  template <class T>
  void write_value(const T& value) {
    write(&value, sizeof value);
  }

  /// Overwrites `count` bytes at `offset`, all of them written before: for a header that counts what follows it.
  void overwrite(std::size_t offset, const void* bytes, std::size_t count);

  /// Bytes written so far.
  std::size_t size() const { return written_ + buffer_.size(); }

  /// Puts the file in place, on the disk. Throws Error naming the path where that fails.
  void commit();

  const std::string& path() const { return path_; }

 private:
  [[noreturn]] void fail(const char* what, int code) const;
  std::string next_name() const;
  void open_temporary();
  void name_temporary();
  void open_directly();
  void flush();
  void close_checked();

  std::string path_;       // as the caller gave it, for errors
  std::string target_;     // path_ with symbolic links followed
  std::string temporary_;  // empty as long as the file has no name
  bool direct_ = false;    // a device or pipe, written to as it is
  std::vector<char> buffer_;
  std::size_t written_ = 0;
  int descriptor_ = -1;
};

/// Names a file that remove_unfinished_files() removes; the name stays the caller's until it is forgotten. Every AtomicFile
/// does this with its temporary file.
void remember_unfinished(const char* name) noexcept;
void forget_unfinished(const char* name) noexcept;

/// Removes every file that is unfinished, without waiting for anything: for a signal handler that is about to end the program.
/// Async-signal-safe.
void remove_unfinished_files() noexcept;

}  // namespace pliant
