// SHA-256 (FIPS 180-4), implemented here because the core has no library dependency.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace pliant {

/// Which block function to use: `portable` C++, or `fastest`, which uses the x86 SHA instructions if the CPU has them.
enum class Sha256Code { fastest, portable };

class Sha256 {
 public:
  explicit Sha256(Sha256Code code = Sha256Code::fastest);
  void add(const void* data, std::size_t size);
  /// Returns the digest as 64 hexadecimal digits. No data may be added afterwards.
  std::string finish();

 private:
  using State = std::array<std::uint32_t, 8>;
  /// A function that adds `count` blocks of 64 bytes to the state.
  using Process = void (*)(State& state, const unsigned char* blocks, std::size_t count);

  Process process_;
  State state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> buffer_{};
  std::size_t buffered_ = 0;
  std::uint64_t size_ = 0;
};

}  // namespace pliant
