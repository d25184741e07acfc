// Bytes set aside while a run lasts, for formats whose file begins with what is known only at its end.
//
// A .glb starts with the list of its frames and a .usda holds one object's frames before the next object's; keeping them in
// memory would cost gigabytes for a large cloth. The spool is a file without a name, so that nothing is left of it whatever
// happens.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "atomic_file.h"

namespace pliant::output {

class Spool {
 public:
  /// `beside` is the file that is being made; the spool lies in its folder. Throws Error naming it.
  explicit Spool(std::string beside);
  ~Spool();
  Spool(Spool&& other) noexcept;
  Spool(const Spool&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  std::size_t size() const { return written_ + buffer_.size(); }

  /// Appends all that was written to `file`.
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
