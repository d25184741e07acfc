// Temporary storage during a run, for formats in which a file begins with what is known only at the end.
//
// A .glb begins with the list of its frames, and a .usda has all frames of one object before those of the next. In
// memory they would take gigabytes for a large cloth. A spool is a file without a name, so nothing remains of it,
// whatever happens. Where the output itself is kept in memory, so is the spool.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "output_file.h"

namespace pliant::output {

class Spool {
 public:
  /// `beside` is the output file; the spool is stored in its folder. Throws an Error that names the output file.
  explicit Spool(std::string beside);
  /// In memory if the writer's files are.
  explicit Spool(const Destination& to);
  ~Spool();
  Spool(Spool&& other) noexcept;
  Spool(const Spool&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  std::size_t size() const { return written_ + buffer_.size(); }

  /// Appends all that the spool contains to `file`.
  void copy_to(OutputFile& file);

 private:
  [[noreturn]] void fail(int code) const;
  void open();
  void flush();

  std::string beside_;
  std::vector<char> buffer_;
  std::size_t written_ = 0;
  int descriptor_ = -1;  // -1: all is in the buffer
};

}  // namespace pliant::output
