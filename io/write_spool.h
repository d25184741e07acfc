// Temporary storage during a run, for formats whose file starts with data known only at the end.
//
// A .glb starts with the list of its frames, and a .usda holds one object's frames
// before the next object's. Keeping them in memory would take gigabytes for a
// large cloth. The spool is a nameless file, so nothing remains of it in any case.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "atomic_file.h"

namespace pliant::output {

class Spool {
 public:
  /// `beside` is the output file; the spool lies in its folder. Throws an Error that names it.
  explicit Spool(std::string beside);
  ~Spool();
  Spool(Spool&& other) noexcept;
  Spool(const Spool&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  std::size_t size() const { return written_ + buffer_.size(); }

  /// Appends the spool's whole content to `file`.
  void copy_to(AtomicFile& file);

 private:
  [[noreturn]] void fail(int code) const;
  void flush();

  std::string beside_;
  std::vector<char> buffer_;
  std::size_t written_ = 0;
  int descriptor_ = -1;
};

}  // namespace pliant::output
