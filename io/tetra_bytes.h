// Numbers and lines of binary formats of tetrahedral meshes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace pliant {

class ByteReader {
 public:
  ByteReader(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  void go_to(std::size_t offset) { at_ = std::min(offset, bytes_.size()); }
  void swap_bytes(bool swaps) { swaps_ = swaps; }
  std::size_t remaining() const { return bytes_.size() - at_; }

  /// The rest of the current line, without its end.
  std::string_view line();

  template <class T>
  T value(const char* what) {
    const std::string_view from = take(sizeof(T), what);
    char raw[sizeof(T)];
    std::copy(from.begin(), from.end(), raw);
    if (swaps_) std::reverse(raw, raw + sizeof raw);
    T result{};
    std::memcpy(&result, raw, sizeof raw);
    return result;
  }

  /// A coordinate that a file has as a number of type T.
  template <class T>
  float coordinate(const char* what) {
    const auto result = static_cast<float>(value<T>(what));
    if (!(result - result == 0)) fail(std::string(what) + " is not finite", "give finite coordinates");
    return result;
  }

  /// Throws an Error unless there is room for `count` of something of `size` bytes each.
  std::int64_t checked(std::int64_t count, std::size_t size, const char* what) const;

  /// Throws an Error at the current byte.
  [[noreturn]] void fail(const std::string& problem, const std::string& advice) const;

 private:
  std::string_view take(std::size_t size, const char* what);

  std::string_view bytes_;
  std::string name_;
  std::size_t at_ = 0;
  bool swaps_ = false;
};

}  // namespace pliant
