// Atomic files: a file appears under its name only after all of its content is on disk.
//
// A simulation's output takes hours to compute and must not be lost. So every writer of this folder writes a temporary
// file in the target folder and checks every call. commit() replaces the target by one rename, which is atomic. Until
// then, or after any failure, the old file stays unchanged.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "output_file.h"

namespace pliant {

/// A file being written. Nothing is visible under `path` before commit() returns.
class AtomicFile final : public OutputFile {
 public:
  /// Creates the temporary file. Follows symbolic links; writes directly to a device or pipe. Throws an Error that
  /// names the path if its folder is missing, or the path is a folder or not writable.
  explicit AtomicFile(std::string path);

  /// Discards the file unless commit() has succeeded.
  ~AtomicFile() override;

  /// Appends bytes. Throws an Error that names the path if the disk is full or the write fails.
  void write(const void* bytes, std::size_t count) override;
  using OutputFile::write;

  void overwrite(std::size_t offset, const void* bytes, std::size_t count) override;
  std::size_t size() const override { return written_ + buffer_.size(); }

  /// Syncs the file to disk and gives it its name. If that fails, throws an Error that names the path.
  void commit() override;

  const std::string& path() const override { return path_; }

 private:
  [[noreturn]] void fail(const char* what, int code) const;
  std::string next_name() const;
  void open_temporary();
  void name_temporary();
  void open_directly();
  void flush();
  void close_checked();

  std::string path_;       // the path as given by the caller, for errors
  std::string target_;     // path_ with symbolic links followed
  std::string temporary_;  // empty while the file has no name
  bool direct_ = false;    // true: a device or pipe, which is written directly
  std::vector<char> buffer_;
  std::size_t written_ = 0;
  int descriptor_ = -1;
};

/// Registers a file for remove_unfinished_files(). The string must stay valid until the file is forgotten. Every
/// AtomicFile registers its temporary file.
void remember_unfinished(const char* name) noexcept;
void forget_unfinished(const char* name) noexcept;

/// Removes all registered files without blocking. A signal handler that is about to end the program may call
/// it.
void remove_unfinished_files() noexcept;

}  // namespace pliant
