// A radix sort, least significant digits first. Each range of items counts its digits, so it knows where its items go.
#include "surface/sort_keys.h"

#include <algorithm>
#include <array>

#include "parallel/ranges.h"

namespace pliant::surface {

namespace {

constexpr int most_digit_bits = 11;
constexpr int range_length = 1 << 14;  ///< the order does not depend on it, because sorting by a digit is stable
using Counts = std::array<int, std::size_t{1} << most_digit_bits>;

int bits_of(int extent) {
  int bits = 0;
  while (bits < 31 && extent >> bits != 0) ++bits;
  return bits;
}

/// Turns the counts of the ranges into the places of their first items.
void find_places(std::vector<Counts>& counts, std::size_t digits) {
  int sum = 0;
  for (std::size_t digit = 0; digit < digits; ++digit)
    for (Counts& of : counts) {
      const int count = of[digit];
      of[digit] = sum;
      sum += count;
    }
}

void sort_by_digit(Executor& executor, const std::vector<Keyed>& items, int shift, int bits,
                   std::vector<Keyed>& sorted) {
  const int count = static_cast<int>(items.size()), length = executor.threads() == 1 ? count : range_length;
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  const auto digit_of = [&](int i) {
    return static_cast<std::size_t>(items[static_cast<std::size_t>(i)].key >> shift & mask);
  };
  std::vector<Counts> counts(static_cast<std::size_t>(ranges_of(count, length)));
  for_ranges(executor, "surface: sort", count, length, [&](int first, int last) {
    Counts& of = counts[static_cast<std::size_t>(first / length)];
    for (int i = first; i < last; ++i) ++of[digit_of(i)];
  });
  find_places(counts, static_cast<std::size_t>(mask) + 1);
  for_ranges(executor, "surface: sort", count, length, [&](int first, int last) {
    Counts& next = counts[static_cast<std::size_t>(first / length)];
    for (int i = first; i < last; ++i)
      sorted[static_cast<std::size_t>(next[digit_of(i)]++)] = items[static_cast<std::size_t>(i)];
  });
}

}  // namespace

void KeyBox::include(const Cell& c) {
  low = {std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z)};
  high = {std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z)};
}

void KeyBox::include(const KeyBox& other) {
  include(other.low);
  include(other.high);
}

void KeyBox::count_bits() {
  x_bits = bits_of(high.x - low.x);
  y_bits = bits_of(high.y - low.y);
  z_bits = bits_of(high.z - low.z);
}

void sort_by_key(Executor& executor, std::vector<Keyed>& items, int bits) {
  std::vector<Keyed> sorted(items.size());
  const int digits = (bits + most_digit_bits - 1) / most_digit_bits;
  for (int digit = 0; digit < digits; ++digit) {
    const int width = (bits + digits - 1) / digits;
    sort_by_digit(executor, items, digit * width, width, sorted);
    items.swap(sorted);
  }
}

}  // namespace pliant::surface
