// A temporary file without a name. It uses POSIX calls for the reasons given in atomic_file.cpp.
#include "write_spool.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "pliant/error.h"

namespace pliant::output {

namespace {
constexpr std::size_t buffer_size = std::size_t{1} << 18;
}

Spool::Spool(std::string beside) : beside_(std::move(beside)) { open(); }

Spool::Spool(const Destination& to) : beside_(to.path) {
  if (to.is_disk()) open();
}

void Spool::open() {
  const std::size_t slash = beside_.rfind('/');
  std::string name = (slash == std::string::npos ? "" : beside_.substr(0, slash + 1)) + ".pliant-spool-XXXXXX";
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail(errno);
  ::unlink(name.c_str());
}

Spool::~Spool() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Spool::Spool(Spool&& other) noexcept
    : beside_(std::move(other.beside_)),
      buffer_(std::move(other.buffer_)),
      written_(other.written_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

void Spool::fail(int code) const {
  throw Error({.file = beside_, .line = 0, .object = {}, .element = {}},
              "cannot create a temporary file for its frames: " + std::generic_category().message(code),
              code == EMFILE || code == ENFILE
                  ? "each object keeps one file open: raise the limit (ulimit -n), or write .ply or .pvd"
                  : "check that its folder exists, is writable and has space");
}

void Spool::write(const void* bytes, std::size_t count) {
  const char* const first = static_cast<const char*>(bytes);
  buffer_.insert(buffer_.end(), first, first + count);
  if (descriptor_ >= 0 && buffer_.size() >= buffer_size) flush();
}

void Spool::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(count < 0 ? errno : ENOSPC);
    done += static_cast<std::size_t>(count);
  }
  written_ += buffer_.size();
  buffer_.clear();
}

void Spool::copy_to(OutputFile& file) {
  if (descriptor_ < 0) return file.write(buffer_.data(), buffer_.size());
  flush();
  std::vector<char> block(buffer_size);
  for (std::size_t at = 0; at < written_;) {
    const std::size_t wanted = std::min(block.size(), written_ - at);
    const ssize_t count = ::pread(descriptor_, block.data(), wanted, static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(count < 0 ? errno : EIO);
    file.write(block.data(), static_cast<std::size_t>(count));
    at += static_cast<std::size_t>(count);
  }
}

}  // namespace pliant::output
