#include "model/tied_bodies.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace pliant {

namespace {

constexpr std::size_t fewest_ties = 3;
constexpr int centre_slot = 0, frame_slot = 1, particle_slot = 2;

int in_slot(const ConstraintList& ties, int tie, int slot) {
  return ties
      .stencils[static_cast<std::size_t>(tie) * static_cast<std::size_t>(ties.size) + static_cast<std::size_t>(slot)];
}

using Body = std::pair<int, int>;  ///< its centre and its frame

/// The ties of each body, in the order of the list, and of each particle only the first one.
std::map<Body, TiesOfBody> by_body(const ConstraintList& ties, std::vector<int>& repeated) {
  std::map<Body, TiesOfBody> bodies;
  std::set<std::pair<Body, int>> known;
  for (int tie = 0; tie < ties.count(); ++tie) {
    const Body body{in_slot(ties, tie, centre_slot), in_slot(ties, tie, frame_slot)};
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
    // A particle may be the centre of another body.
    std::vector<std::size_t> points{static_cast<std::size_t>(body.first)};
    for (const int tie : members) points.push_back(static_cast<std::size_t>(in_slot(ties, tie, particle_slot)));
    std::size_t colour = 0;
    for (const std::size_t point : points) colour = std::max(colour, next_colour[point]);
    for (const std::size_t point : points) next_colour[point] = colour + 1;
    result.colours.resize(std::max(result.colours.size(), colour + 1));
    result.colours[colour].push_back(std::move(members));
  }
  std::sort(result.singles.begin(), result.singles.end());
  return result;
}

}  // namespace pliant
