// Greedy colouring of constraints; contiguous groups of four come first.
//
// Constraints are sorted by the shape of their stencil (the differences between slots), then by their first particle.
// Four successive ones with first particles a, a + 1, a + 2, a + 3 form a contiguous group: one load fetches a slot of
// all four. On a grid, greedy first-fit in this order needs only as many colours as a particle has edges.
#include "topology/colouring.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace pliant {

namespace {

constexpr int bits = 64;
constexpr std::size_t batch = 16;             // constraints that are projected together
constexpr std::size_t fewest_to_group = 512;  // below this many ungrouped constraints, partial grouping does not pay

struct Key {
  std::array<int, largest_grouped_stencil>
      shape;  // difference of each slot's particle to slot 0; slot 0 itself comes last
  int member;
  friend bool operator<(const Key& a, const Key& b) {
    for (std::size_t i = 0; i < largest_grouped_stencil; ++i)
      if (a.shape[i] != b.shape[i]) return a.shape[i] < b.shape[i];
    return a.member < b.member;
  }
};

std::vector<Key> sorted_by_shape(const std::vector<int>& stencils, int size, const std::vector<int>& members) {
  std::vector<Key> keys;
  keys.reserve(members.size());
  for (int member : members) {
    const int* stencil = &stencils[static_cast<std::size_t>(size) * member];
    Key key{{}, member};
    for (int slot = 1; slot < size; ++slot) key.shape[slot - 1] = stencil[slot] - stencil[0];
    key.shape[largest_grouped_stencil - 1] = stencil[0];
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// True if the four constraints from `key` on form a contiguous group in which no particle occurs twice.
bool is_run(const Key* key, int size) {
  for (int l = 1; l < 4; ++l) {
    Key expected = key[0];
    expected.shape[largest_grouped_stencil - 1] += l;
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

/// The constraints of one colour, sorted by which slots are contiguous: the index is a bit set of slots.
using Class = std::array<std::vector<int>, 1 << largest_grouped_stencil>;

/// Moves groups that do not fill a batch to a class with fewer contiguous slots, or to the single constraints.
void demote_rest(int runs, Class& members) {
  const std::size_t whole = members[runs].size() / batch * batch;
  int to = 0;
  for (int fewer = 1; fewer < runs; ++fewer) {
    if ((fewer & ~runs) == 0 && !members[fewer].empty()) to = fewer;
  }
  const auto rest = members[runs].begin() + static_cast<std::ptrdiff_t>(whole);
  members[to].insert(members[to].end(), rest, members[runs].end());
  members[runs].resize(whole);
}

/// Appends the constraints of a colour, those with most contiguous slots first. Single constraints are sorted by their
/// first particle, so that a batch's particles are close in memory. Order within a colour changes no bits.
void append_class(const std::vector<int>& stencils, int size, Class& members, std::vector<Colour>& colours) {
  const int all = size > largest_grouped_stencil ? 0 : (1 << size) - 1;
  for (int runs = all; runs > 0; --runs) {
    if (runs < all) demote_rest(runs, members);
    if (!members[runs].empty()) colours.push_back({runs, std::move(members[runs])});
  }
  const auto first = [&](int member) { return stencils[static_cast<std::size_t>(size) * member]; };
  std::sort(members[0].begin(), members[0].end(), [&](int a, int b) { return first(a) < first(b); });
  if (!members[0].empty()) colours.push_back({0, std::move(members[0])});
}

/// Calls run(key) for the first member of each contiguous group and single(key) for each ungrouped constraint, in
/// order.
template <class Run, class Single>
void for_runs(const std::vector<Key>& keys, int size, const Run& run, const Single& single) {
  for (std::size_t i = 0; i < keys.size();) {
    const bool is = i + 4 <= keys.size() && is_run(&keys[i], size);
    is ? run(&keys[i]) : single(keys[i]);
    i += is ? 4 : 1;
  }
}

/// Takes groups of four that are contiguous in some slots; none if they are few, because they would not fill batches.
std::vector<Four> take_fours_if_many(const std::vector<int>& stencils, int size, std::vector<int>& members) {
  if (members.size() < fewest_to_group) return {};
  std::vector<int> rest = members;
  std::vector<Four> fours = take_fours(stencils, size, rest);
  if (rest.size() > members.size() / 4 * 3) return {};
  members = std::move(rest);
  return fours;
}

}  // namespace

double share_in_runs(const std::vector<int>& stencils, int size) {
  std::vector<int> members(stencils.size() / static_cast<std::size_t>(size));
  std::iota(members.begin(), members.end(), 0);
  if (members.empty()) return 1;
  std::size_t in_runs = 0;
  for_runs(
      sorted_by_shape(stencils, size, members), size, [&](const Key*) { in_runs += 4; }, [](const Key&) {});
  return static_cast<double>(in_runs) / static_cast<double>(members.size());
}

int Colouring::first_free(const int* particles, int count) {
  std::uint64_t used = 0;
  for (int i = 0; i < count; ++i) used |= used_[particles[i]];
  if (~used != 0) {
    int colour = 0;
    while (used >> colour & 1) ++colour;
    use(particles, count, colour);
    return colour;
  }
  int colour = bits;
  for (int i = 0; i < count; ++i) colour = std::max(colour, next_[particles[i]]);
  use(particles, count, colour);
  return colour;
}

/// Marks a colour as one that these particles have; of colours beyond 64 they have all lower ones, too.
void Colouring::use(const int* particles, int count, int colour) {
  for (int i = 0; i < count; ++i) {
    if (colour < bits)
      used_[particles[i]] |= std::uint64_t{1} << colour;
    else
      next_[particles[i]] = std::max(next_[particles[i]], colour + 1);
  }
}

/// Colours by first fit, using only new colours. A group of four gets one colour as a whole.
void Colouring::append(const std::vector<int>& stencils, int size, const std::vector<Four>& fours,
                       const std::vector<int>& singles, std::vector<Colour>& colours) {
  std::vector<Class> classes;
  const auto class_of = [&](const std::vector<int>& particles) -> Class& {
    const auto colour = static_cast<std::size_t>(first_free(particles.data(), static_cast<int>(particles.size())));
    if (classes.size() <= colour) classes.resize(colour + 1);
    return classes[colour];
  };
  std::vector<int> particles;
  const auto add_particles = [&](int member) {
    const int* stencil = &stencils[static_cast<std::size_t>(size) * member];
    particles.insert(particles.end(), stencil, stencil + size);
  };
  for (const Four& four : fours) {
    particles.clear();
    for (int member : four.members) add_particles(member);
    std::vector<int>& members = class_of(particles)[four.runs];
    members.insert(members.end(), four.members.begin(), four.members.end());
  }
  for (int member : singles) {
    particles.clear();
    add_particles(member);
    class_of(particles)[0].push_back(member);
  }
  for (Class& members : classes) append_class(stencils, size, members, colours);
}

void Colouring::reset(const std::vector<int>& stencils, int size, const std::vector<int>& members) {
  for (int member : members) {
    for (int slot = 0; slot < size; ++slot) {
      used_[stencils[static_cast<std::size_t>(size) * member + slot]] = 0;
      next_[stencils[static_cast<std::size_t>(size) * member + slot]] = 0;
    }
  }
}

void Colouring::extend(const std::vector<int>& stencils, int size, const std::vector<int>& members,
                       std::vector<Colour>& colours) {
  const auto stencil = [&](int member) { return &stencils[static_cast<std::size_t>(size) * member]; };
  for (const Colour& colour : colours) reset(stencils, size, colour.members);
  reset(stencils, size, members);
  for (std::size_t c = 0; c < colours.size(); ++c)
    for (const int member : colours[c].members) use(stencil(member), size, static_cast<int>(c));
  for (const int member : members) {
    const auto colour = static_cast<std::size_t>(first_free(stencil(member), size));
    if (colour >= colours.size()) colours.resize(colour + 1);
    colours[colour].members.push_back(member);
  }
  std::erase_if(colours, [](const Colour& colour) { return colour.members.empty(); });
}

std::vector<Colour> Colouring::colour_singly(const std::vector<int>& stencils, int size,
                                             const std::vector<int>& members) {
  std::vector<Colour> colours;
  reset(stencils, size, members);
  append(stencils, size, {}, members, colours);
  return colours;
}

std::vector<Colour> Colouring::colour(const std::vector<int>& stencils, int size, const std::vector<int>& members) {
  if (size > largest_grouped_stencil) return colour_singly(stencils, size, members);
  std::vector<Colour> colours;
  std::vector<Four> fours;
  std::vector<int> rest;
  const int all = (1 << size) - 1;
  for_runs(
      sorted_by_shape(stencils, size, members), size,
      [&](const Key* key) {
        fours.push_back({all, {key[0].member, key[1].member, key[2].member, key[3].member}});
      },
      [&](const Key& key) { rest.push_back(key.member); });
  reset(stencils, size, members);
  append(stencils, size, fours, {}, colours);

  // The remaining single constraints get new colours too.
  fours.clear();
  if (rest.size() > members.size() / 4) fours = take_fours_if_many(stencils, size, rest);
  reset(stencils, size, members);
  append(stencils, size, fours, rest, colours);
  return colours;
}

}  // namespace pliant
