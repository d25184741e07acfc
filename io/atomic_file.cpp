// Writes to a temporary file, checks every call, and renames. It uses POSIX calls, because a stream can neither say why
// it failed nor sync to disk.
#include "atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "pliant/error.h"

namespace pliant {

static_assert(std::endian::native == std::endian::little, "binary files are written in the machine's own order");

namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 18;

const char* advice(int code) {
  switch (code) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "free some space, or write somewhere else";
    case ENOENT:
    case ENOTDIR:
      return "create the folder first, or write somewhere else";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a path with write permission";
    case EISDIR:
      return "name a file, not a folder";
    default:
      return "write somewhere else";
  }
}

/// The names of unfinished files. If the table is full, remove_unfinished_files() leaves further files behind.
std::array<std::atomic<const char*>, 256> unfinished{};
static_assert(std::atomic<const char*>::is_always_lock_free, "a signal handler reads it");

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

std::string follow_links(const std::string& path) {
  char* const resolved = ::realpath(path.c_str(), nullptr);
  if (resolved == nullptr) return path;
  std::string result = resolved;
  std::free(resolved);
  return result;
}

/// Writes all bytes, in as many calls as needed. Returns 0 or the error code.
int write_all(int descriptor, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t done = ::write(descriptor, bytes, count);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return errno;
    if (done == 0) return ENOSPC;
    bytes += done;
    count -= static_cast<std::size_t>(done);
  }
  return 0;
}

std::string name_of_descriptor(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

/// Opens a file without a name, which vanishes when the program ends for any reason; -1 if the system has no such
/// files.
int open_nameless(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0 || ::access(name_of_descriptor(descriptor).c_str(), F_OK) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), target_(path_) {
  if (path_.empty()) throw Error({}, "the output path is empty", "give a path");
  if (path_.find('\0') != std::string::npos) throw Error({}, "the path contains a zero byte", "give another path");
  buffer_.reserve(buffer_size);
  struct stat status {};
  const bool exists = ::stat(path_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail("cannot write", EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    open_directly();
    return;
  }
  if (exists) target_ = follow_links(path_);
  if (exists && ::access(target_.c_str(), W_OK) != 0) fail("cannot write", errno);
  open_temporary();
  // A failure is ignored, because some file systems have no permissions.
  if (exists) (void)!::fchmod(descriptor_, status.st_mode & 0777);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  forget_unfinished(temporary_.c_str());
}

void AtomicFile::fail(const char* what, int code) const {
  throw Error({.file = path_, .line = 0, .object = {}, .element = {}},
              std::string(what) + ": " + std::generic_category().message(code), advice(code));
}

/// A short unique name: the target's name with a suffix could exceed the file system's limit.
std::string AtomicFile::next_name() const {
  static std::atomic<unsigned> counter{0};
  return folder_of(target_) + "/.pliant-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".part";
}

void AtomicFile::open_temporary() {
  descriptor_ = open_nameless(folder_of(target_));
  if (descriptor_ >= 0) return;
  constexpr int attempts = 100;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    std::string name = next_name();
    descriptor_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) {
      temporary_ = std::move(name);
      remember_unfinished(temporary_.c_str());
      return;
    }
    if (errno != EEXIST) break;
  }
  fail("cannot write", errno);
}

/// Gives a nameless file a name, because only named files can be renamed.
void AtomicFile::name_temporary() {
  if (!temporary_.empty()) return;
  const std::string self = name_of_descriptor(descriptor_);
  for (;;) {
    temporary_ = next_name();
    remember_unfinished(temporary_.c_str());
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) == 0) return;
    const int code = errno;
    forget_unfinished(temporary_.c_str());
    temporary_.clear();
    if (code != EEXIST) fail("cannot rename the temporary file", code);
  }
}

void AtomicFile::open_directly() {
  // Without O_NONBLOCK, opening a pipe without a reader would block forever.
  direct_ = true;
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) fail("cannot write", errno);
  const int flags = ::fcntl(descriptor_, F_GETFL);
  if (flags >= 0) ::fcntl(descriptor_, F_SETFL, flags & ~O_NONBLOCK);
}

void AtomicFile::write(const void* bytes, std::size_t count) {
  if (buffer_.size() + count > buffer_size) flush();
  const char* const first = static_cast<const char*>(bytes);
  if (count < buffer_size) {
    buffer_.insert(buffer_.end(), first, first + count);
    return;
  }
  if (const int code = write_all(descriptor_, first, count)) fail("cannot write", code);
  written_ += count;
}

void AtomicFile::overwrite(std::size_t offset, const void* bytes, std::size_t count) {
  if (offset + count > size())
    throw Error({.file = path_, .line = 0, .object = {}, .element = {}},
                "cannot overwrite bytes beyond the end of the file");
  flush();
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t done = ::pwrite(descriptor_, next, count, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail("cannot write", done < 0 ? errno : ENOSPC);
    next += done;
    offset += static_cast<std::size_t>(done);
    count -= static_cast<std::size_t>(done);
  }
}

void AtomicFile::flush() {
  if (const int code = write_all(descriptor_, buffer_.data(), buffer_.size())) fail("cannot write", code);
  written_ += buffer_.size();
  buffer_.clear();
}

void AtomicFile::close_checked() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0 && errno != EINTR) fail("cannot write", errno);
}

void AtomicFile::commit() {
  if (descriptor_ < 0)
    throw Error({.file = path_, .line = 0, .object = {}, .element = {}}, "has already been committed");
  flush();
  if (direct_) return close_checked();
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail("cannot write", errno);
  name_temporary();
  close_checked();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot rename the temporary file", errno);
  forget_unfinished(temporary_.c_str());
  temporary_.clear();
  // The folder stores the rename, so it is synced too. If that fails, the file is complete anyway.
  const int folder = ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

void remember_unfinished(const char* name) noexcept {
  for (auto& place : unfinished) {
    const char* none = nullptr;
    if (place.compare_exchange_strong(none, name)) return;
  }
}

void forget_unfinished(const char* name) noexcept {
  for (auto& place : unfinished) {
    const char* found = name;
    if (place.compare_exchange_strong(found, nullptr)) return;
  }
}

void remove_unfinished_files() noexcept {
  for (auto& place : unfinished)
    if (const char* const name = place.load()) ::unlink(name);
}

}  // namespace pliant
