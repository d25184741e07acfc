#include "vtu_data.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

#ifdef PLIANT_ZLIB
#include <zlib.h>
#endif

namespace pliant {

namespace {

/// The six bits of a character of base64; -1: none.
int bits_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Bytes one after another. In base64 a part may end in '=', after which another begins.
class VtuBytes {
 public:
  VtuBytes(std::string_view from, const VtuEncoding& encoding, const VtuFail& fail)
      : from_(from), encoding_(encoding), fail_(fail) {}

  /// No more bytes than these can follow.
  std::uint64_t remaining() const {
    const std::uint64_t left = from_.size() - at_;
    return encoding_.is_base64 ? left / 4 * 3 + 3 + decoded_.size() : left;
  }

  std::string take(std::uint64_t count) {
    if (count > remaining()) fail_("ends within an array", "the file is cut off: export it again");
    const auto size = static_cast<std::size_t>(count);
    if (!encoding_.is_base64) {
      at_ += size;
      return std::string(from_.substr(at_ - size, size));
    }
    while (decoded_.size() < size) decode_four();
    std::string out = decoded_.substr(0, size);
    decoded_.erase(0, size);
    return out;
  }

  std::uint64_t header() {
    std::string bytes = take(encoding_.has_long_headers ? 8 : 4);
    if (encoding_.has_big_end_first) std::reverse(bytes.begin(), bytes.end());
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data(), bytes.size());
    return value;
  }

 private:
  void decode_four() {
    std::uint32_t sum = 0;
    int digits = 0, padding = 0;
    for (; digits + padding < 4; ++at_) {
      if (at_ >= from_.size()) fail_("ends within an array", "the file is cut off: export it again");
      const char c = from_[at_];
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
      const int bits = bits_of(c);
      if (c == '=' && digits >= 2) {
        ++padding;
        sum <<= 6;
      } else if (bits >= 0 && padding == 0) {
        ++digits;
        sum = sum << 6 | static_cast<std::uint32_t>(bits);
      } else {
        fail_("has a character that is none of base64", "the file is damaged");
      }
    }
    for (int byte = 0; byte < 3 - padding; ++byte) decoded_.push_back(static_cast<char>(sum >> (16 - 8 * byte) & 0xff));
  }

  std::string_view from_;
  const VtuEncoding& encoding_;
  const VtuFail& fail_;
  std::size_t at_ = 0;
  std::string decoded_;
};

#ifdef PLIANT_ZLIB
/// Piece by piece, so that memory grows with what really comes out.
void inflate_to(const std::string& from, std::size_t size, std::string& out, const VtuFail& fail) {
  std::array<char, 1 << 16> piece;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) fail("cannot be inflated", "give zlib more memory");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(from.data()));  // zlib does not write to it
  stream.avail_in = static_cast<uInt>(from.size());
  const std::size_t start = out.size();
  int result = Z_OK;
  while (result == Z_OK && out.size() - start <= size) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    result = inflate(&stream, Z_NO_FLUSH);
    out.append(piece.data(), piece.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (result != Z_STREAM_END || out.size() - start != size)
    fail("has a block that zlib cannot read", "the file is damaged: export it again");
}
#else
void inflate_to(const std::string&, std::size_t, std::string&, const VtuFail& fail) {
  fail("is compressed, and this build has no zlib",
       "install Debian's zlib1g-dev and build again, or export without compression");
}
#endif

std::string compressed(VtuBytes& from, const VtuFail& fail) {
  constexpr std::uint64_t most_ratio = 1100;  // zlib's greatest is below it
  const std::uint64_t blocks = from.header(), whole = from.header(), last = from.header();
  if (blocks > from.remaining() / 4 + 1) fail("has more blocks than bytes", "the file is damaged");
  std::vector<std::uint64_t> sizes;
  for (std::uint64_t i = 0; i < blocks; ++i) sizes.push_back(from.header());
  std::string out;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const std::uint64_t size = i + 1 == blocks && last > 0 ? last : whole;
    if (sizes[i] > from.remaining() || size > most_ratio * (sizes[i] + 1))
      fail("has a block larger than the file", "the file is damaged");
    inflate_to(from.take(sizes[i]), static_cast<std::size_t>(size), out, fail);
  }
  return out;
}

}  // namespace

std::string vtu_array(std::string_view from, const VtuEncoding& encoding, const VtuFail& fail) {
  VtuBytes bytes(from, encoding, fail);
  return encoding.is_compressed ? compressed(bytes, fail) : bytes.take(bytes.header());
}

}  // namespace pliant
