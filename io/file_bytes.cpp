// Reads files by POSIX calls: a stream would block forever on a pipe, read a device without end, and not say what
// failed.
#include "file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "pliant/error.h"

namespace pliant {

namespace {

/// A file descriptor that is closed on every path out of a function.
class Descriptor {
 public:
  explicit Descriptor(const std::string& path)
      // Without O_NONBLOCK, opening a pipe without a writer would block forever.
      : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
    if (number_ >= 0) return;
    const int code = errno;
    refuse_file(path, "cannot open: " + std::generic_category().message(code),
                code == ENOENT ? "check the path; a relative one starts at the current folder"
                               : "check the path and its permissions");
  }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

void refuse_what_is_no_file(const struct stat& status, const std::string& path) {
  if (S_ISREG(status.st_mode)) return;
  if (S_ISDIR(status.st_mode)) refuse_file(path, "is a folder", "name a file");
  refuse_file(path, "is a pipe, socket or device, not a regular file", "copy its content into a file first");
}

void refuse_large(std::uint64_t size, std::uint64_t most, const std::string& path) {
  if (size <= most) return;
  refuse_file(path, "is larger than " + std::to_string(most) + " bytes, the limit of the reader",
              "split it or simplify it");
}

}  // namespace

void refuse_file(const std::string& path, const std::string& problem, const std::string& advice) {
  throw Error({.file = path, .line = 0, .object = {}, .element = {}}, problem, advice);
}

std::string read_file_bytes(const std::string& path, std::uint64_t most, AtMost at_most) {
  if (path.empty()) throw Error({}, "the input path is empty", "give a path");
  if (path.find('\0') != std::string::npos) throw Error({}, "the path contains a zero byte", "give another path");
  const Descriptor file(path);
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) refuse_file(path, "cannot be examined", "check its permissions");
  refuse_what_is_no_file(status, path);
  const bool whole = at_most == AtMost::refuse;
  if (whole) refuse_large(static_cast<std::uint64_t>(status.st_size), most, path);

  // Reads to the end of the file, whatever size it had: that may change meanwhile, and some virtual files report 0.
  std::string bytes;
  bytes.resize(static_cast<std::size_t>(std::min(static_cast<std::uint64_t>(status.st_size), most)) + 1);
  std::size_t done = 0;
  for (;;) {
    const ssize_t got = ::read(file.number(), bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse_file(path, "cannot read: " + std::generic_category().message(errno), "check the disk");
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
    if (whole) refuse_large(done, most, path);
    if (!whole && done >= most) break;
    if (done == bytes.size()) bytes.resize(done + std::max<std::size_t>(done, 4096));
  }
  bytes.resize(whole ? done : std::min<std::size_t>(done, most));
  return bytes;
}

}  // namespace pliant
