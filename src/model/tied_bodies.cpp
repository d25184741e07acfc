#include "model/tied_bodies.h"

#include <algorithm>
#include <map>
#include <set>

namespace pliant {

namespace {

constexpr std::size_t fewest_ties = 3;
constexpr int body_slot = 0, particle_slot = 2;

int in_slot(const ConstraintList& ties, int tie, int slot) {
  return ties
      .stencils[static_cast<std::size_t>(tie) * static_cast<std::size_t>(ties.size) + static_cast<std::size_t>(slot)];
}

/// The ties of each body, in the order of the list, and of each particle only the first one.
std::map<int, TiesOfBody> by_body(const ConstraintList& ties, std::vector<int>& repeated) {
  std::map<int, TiesOfBody> bodies;
  std::set<std::pair<int, int>> known;
  for (int tie = 0; tie < ties.count(); ++tie) {
    const int body = in_slot(ties, tie, body_slot);
    if (known.insert({body, in_slot(ties, tie, particle_slot)}).second)
      bodies[body].push_back(tie);
    else
      repeated.push_back(tie);
  }
  return bodies;
}

}  // namespace

TiedBodies find_tied_bodies(const ConstraintList& ties, int particles) {
  TiedBodies result;
  std::vector<std::size_t> next_colour(static_cast<std::size_t>(particles), 0);
  for (auto& [body, members] : by_body(ties, result.singles)) {
    if (members.size() < fewest_ties) {
      result.singles.insert(result.singles.end(), members.begin(), members.end());
      continue;
    }
    std::size_t colour = 0;
    for (const int tie : members)
      colour = std::max(colour, next_colour[static_cast<std::size_t>(in_slot(ties, tie, particle_slot))]);
    for (const int tie : members) next_colour[static_cast<std::size_t>(in_slot(ties, tie, particle_slot))] = colour + 1;
    result.colours.resize(std::max(result.colours.size(), colour + 1));
    result.colours[colour].push_back(std::move(members));
  }
  std::sort(result.singles.begin(), result.singles.end());
  return result;
}

}  // namespace pliant
