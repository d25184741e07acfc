// Tests that host and device give the same bits, for a million inputs to each formula: ordinary ones, and odd ones of
// every kind.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "device.h"
#include "probe.h"

namespace pliant::cuda {
namespace {

/// The generator SplitMix64: short, and the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  float between(float low, float high) {
    return low + (high - low) * (static_cast<float>(next() >> 40) * (1.f / 16777216));
  }

 private:
  std::uint64_t state_;
};

float odd_number(Random& random) {
  constexpr float largest = std::numeric_limits<float>::max();
  constexpr std::array<float, 12> odd{0.f,    -0.f,  1.f,     -1.f,     1e-45f, -1e-40f,
                                      1e-20f, 1e20f, largest, -largest, 0.5f,   3.14159274f};
  if (random.next() % 2 == 0) return odd[random.next() % odd.size()];
  const auto bits = static_cast<std::uint32_t>(random.next());
  float any;
  std::memcpy(&any, &bits, sizeof any);
  return any;
}

/// Of every eight inputs, six have the sizes of cloth in metres, one has repeated values (coincident points), one has
/// any bits.
std::vector<float> make_inputs(int count, int width, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> inputs;
  inputs.reserve(static_cast<std::size_t>(count) * static_cast<std::size_t>(width));
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < width; ++j) {
      const int kind = i % 8;
      if (kind < 6) inputs.push_back(random.between(-1.5f, 1.5f));
      if (kind == 6) inputs.push_back(static_cast<float>(random.next() % 3) - 1);
      if (kind == 7) inputs.push_back(odd_number(random));
    }
  }
  return inputs;
}

bool same(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0 ||
         (std::isnan(a) && std::isnan(b));  // payloads of NaN differ between machines
}

template <class Probe>
void compare(int index) {
  SCOPED_TRACE(Probe::name);
  constexpr int count = 1 << 20;
  const std::vector<float> inputs = make_inputs(count, Probe::inputs, 2026 + static_cast<std::uint64_t>(index));
  const std::vector<float> device = run_on_device(index, inputs, count, Probe::outputs);
  ASSERT_EQ(device.size(), static_cast<std::size_t>(count) * Probe::outputs);
  int different = 0;
  for (std::size_t i = 0; i < count; ++i) {
    float host[Probe::outputs];
    Probe::run(&inputs[i * Probe::inputs], host);
    for (std::size_t j = 0; j < Probe::outputs; ++j) {
      const float there = device[i * Probe::outputs + j];
      if (same(host[j], there)) continue;
      if (++different <= 5)
        ADD_FAILURE() << "input " << i << ", output " << j << ": host " << host[j] << ", device " << there;
    }
  }
  EXPECT_EQ(different, 0);
}

TEST(Cuda, SameBitsOnHostAndDevice) {
  const std::string reason = why_no_device();
  if (!reason.empty()) GTEST_SKIP() << "no device to compare with: " << reason;
  for_each_type(AllProbes{}, [](auto tag, int index) { compare<typename decltype(tag)::type>(index); });
}

}  // namespace
}  // namespace pliant::cuda
