// Greedy colouring, fours first.
//
// Constraints are sorted by the shape of their stencil (the differences between slots), then by its place. Neighbours in that order
// with places a, a + 1, a + 2, a + 3 are a run: one load fetches a slot of all four. Greedy first-fit in that order colours a
// grid's families of edges with as few colours as particles have edges.
#include "topology/colouring.h"

#include <algorithm>
#include <array>

namespace pliant {

namespace {

constexpr int bits = 64;
constexpr int largest_stencil = 4;

struct Key {
  std::array<int, largest_stencil> shape;  // differences to slot 0, then slot 0 itself last
  int member;
  friend bool operator<(const Key& a, const Key& b) { return a.shape != b.shape ? a.shape < b.shape : a.member < b.member; }
};

std::vector<Key> sorted_by_shape(const std::vector<int>& stencils, int size, const std::vector<int>& members) {
  std::vector<Key> keys;
  keys.reserve(members.size());
  for (int member : members) {
    const int* stencil = &stencils[static_cast<std::size_t>(size) * member];
    Key key{{}, member};
    for (int slot = 1; slot < size; ++slot) key.shape[slot - 1] = stencil[slot] - stencil[0];
    key.shape[largest_stencil - 1] = stencil[0];
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// Whether the four constraints from key on are a run, and no particle is in two of them.
bool is_run(const Key* key, int size) {
  for (int l = 1; l < 4; ++l) {
    Key expected = key[0];
    expected.shape[largest_stencil - 1] += l;
    if (key[l].shape != expected.shape) return false;
  }
  for (int slot = 0; slot + 1 < size; ++slot) {
    if (std::abs(key[0].shape[slot]) < 4) return false;
    for (int other = 0; other < slot; ++other) {
      if (std::abs(key[0].shape[slot] - key[0].shape[other]) < 4) return false;
    }
  }
  return true;
}

void add(std::vector<Colour>& colours, std::vector<int>& number_of, int colour, bool runs, int member) {
  if (static_cast<int>(number_of.size()) <= colour) number_of.resize(colour + 1, -1);
  if (number_of[colour] < 0) {
    number_of[colour] = static_cast<int>(colours.size());
    colours.push_back({runs, {}});
  }
  colours[number_of[colour]].members.push_back(member);
}

}  // namespace

int Colouring::first_free(const int* particles, int count) {
  std::uint64_t used = 0;
  for (int i = 0; i < count; ++i) used |= used_[particles[i]];
  if (~used != 0) {
    int colour = 0;
    while (used >> colour & 1) ++colour;
    for (int i = 0; i < count; ++i) used_[particles[i]] |= std::uint64_t{1} << colour;
    return colour;
  }
  int colour = bits;
  for (int i = 0; i < count; ++i) colour = std::max(colour, next_[particles[i]]);
  for (int i = 0; i < count; ++i) next_[particles[i]] = colour + 1;
  return colour;
}

void Colouring::reset(const std::vector<int>& stencils, int size, const std::vector<int>& members) {
  for (int member : members) {
    for (int slot = 0; slot < size; ++slot) {
      used_[stencils[static_cast<std::size_t>(size) * member + slot]] = 0;
      next_[stencils[static_cast<std::size_t>(size) * member + slot]] = 0;
    }
  }
}

std::vector<Colour> Colouring::colour(const std::vector<int>& stencils, int size, const std::vector<int>& members) {
  const std::vector<Key> keys = sorted_by_shape(stencils, size, members);
  std::vector<Colour> colours;
  std::vector<int> singles, number_of;
  std::vector<int> together(4 * static_cast<std::size_t>(size));

  // Runs of four, each coloured as one.
  reset(stencils, size, members);
  for (std::size_t i = 0; i < keys.size();) {
    if (i + 4 > keys.size() || !is_run(&keys[i], size)) {
      singles.push_back(keys[i++].member);
      continue;
    }
    for (int l = 0; l < 4; ++l) {
      for (int slot = 0; slot < size; ++slot) {
        together[l * size + slot] = stencils[static_cast<std::size_t>(size) * keys[i + l].member + slot];
      }
    }
    const int colour = first_free(together.data(), 4 * size);
    for (int l = 0; l < 4; ++l) add(colours, number_of, colour, true, keys[i + l].member);
    i += 4;
  }

  // What is left, in colours of its own.
  reset(stencils, size, members);
  number_of.clear();
  for (int member : singles) {
    const int colour = first_free(&stencils[static_cast<std::size_t>(size) * member], size);
    add(colours, number_of, colour, false, member);
  }
  return colours;
}

}  // namespace pliant
