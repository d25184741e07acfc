#include "tetra_bytes.h"

#include "pliant/error.h"

namespace pliant {

void ByteReader::fail(const std::string& problem, const std::string& advice) const {
  throw Error({.file = name_, .element = "byte " + std::to_string(at_)}, problem, advice);
}

std::string_view ByteReader::take(std::size_t size, const char* what) {
  if (size > remaining())
    fail(std::string("ends where ") + what + " should follow", "the file is cut off: export it again");
  at_ += size;
  return bytes_.substr(at_ - size, size);
}

std::string_view ByteReader::line() {
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  std::string_view line = bytes_.substr(at_, end - at_);
  at_ = std::min(end + 1, bytes_.size());
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::int64_t ByteReader::checked(std::int64_t count, std::size_t size, const char* what) const {
  if (count < 0 || static_cast<std::uint64_t>(count) > remaining() / size)
    fail(std::string(what) + " is " + std::to_string(count) + ", for which the file is too short",
         "the file is damaged or cut off: export it again");
  return count;
}

}  // namespace pliant
