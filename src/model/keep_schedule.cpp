#include "model/keep_schedule.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "constraints/registry.h"
#include "core/at.h"
#include "pliant/error.h"

namespace pliant {

namespace {

int constraints_in(const Segment& segment) {
  return (segment.batches - 1) * batch_width + segment.last_count * (segment.runs != 0 ? 4 : 1);
}

/// Appends the constraints of a segment in the order in which they were given to it.
void append_constraints(const Pool& pool, const Segment& segment, std::vector<int>& out) {
  for (int i = 0; i < constraints_in(segment); ++i) {
    const int in_batch = i % batch_width, lane = segment.runs != 0 ? 4 * (in_batch % 4) + in_batch / 4 : in_batch;
    out.push_back(pool.origin[at(segment.first_batch + i / batch_width) * batch_width + at(lane)]);
  }
}

/// The colour that some segments of one pool are.
KeptSchedule::Colour colour_of(const CompiledObject& object, int first, int last, int tile) {
  const Segment& segment = object.segments[at(first)];
  const Pool& pool = object.pools[at(segment.pool)];
  const std::vector<char>& added = object.additions.segments;
  KeptSchedule::Colour colour{
      pool.type, static_cast<int>(pool.law), tile, segment.runs, at(first) < added.size() && added[at(first)] != 0, {}};
  for (int s = first; s < last; ++s) append_constraints(pool, object.segments[at(s)], colour.constraints);
  return colour;
}

}  // namespace

KeptSchedule schedule_of(const CompiledObject& object) {
  KeptSchedule out;
  out.order = object.order;
  out.first_added = object.additions.are_used ? object.additions.first_particle : object.particles;
  out.fans = object.fans;
  for (std::size_t t = 0; t < object.tiles.size(); ++t) {
    const Tile& tile = object.tiles[t];
    out.tile_ends.push_back(tile.last_particle);
    for (int s = tile.first_segment; s < tile.last_segment; ++s)
      out.colours.push_back(colour_of(object, s, s + 1, static_cast<int>(t)));
  }
  for (const ObjectPhase& phase : object.phases)
    if (phase.driver == Driver::inter_tile) out.colours.push_back(colour_of(object, phase.first, phase.last, -1));
  return out;
}

bool has_many_additions(const CompiledObject& object) {
  std::int64_t all = 0, added = 0;
  for (std::size_t s = 0; s < object.additions.segments.size(); ++s) {
    const int count = constraints_in(object.segments[s]);
    all += count;
    added += object.additions.segments[s] != 0 ? count : 0;
  }
  return 4 * added > all;
}

void require_fits(const KeptSchedule& kept, std::size_t particles, const std::string& name) {
  const auto refuse = [&](const std::string& problem) {
    throw Error({.object = name}, "its schedule does not fit: " + problem,
                "use the scene and the layout() of the same World at the same time");
  };
  std::vector<char> is_there(particles, 0);
  if (kept.order.size() != particles) refuse("it is one of " + std::to_string(kept.order.size()) + " particles");
  for (const int user : kept.order) {
    if (user < 0 || at(user) >= particles || is_there[at(user)] != 0) refuse("it does not number each particle once");
    is_there[at(user)] = 1;
  }
  int last = 0;
  for (const int end : kept.tile_ends) {
    if (end <= last) refuse("a tile has no particles");
    last = end;
  }
  if (at(last) != particles) refuse("its tiles do not have all particles");
  const bool begins_a_tile =
      std::find(kept.tile_ends.begin(), kept.tile_ends.end(), kept.first_added) != kept.tile_ends.end();
  if (!begins_a_tile) refuse("particles that were added do not begin with a tile");
}

namespace {

/// Decides which constraints keep their colours.
class ColourKeeper {
 public:
  ColourKeeper(ConstraintList& list, const std::vector<int>& tile_of, int tiles)
      : stencils_(list.stencils.own()), size_(list.size), tile_of_(tile_of), tiles_(tiles), last_(tile_of.size(), -1) {
    out_.of_tile.resize(at(tiles) + 1);
    out_.is_kept.assign(at(list.count()), 0);
    member_of_.resize(at(list.count()), -1);
    for (int i = 0; i < list.count(); ++i) {
      const std::size_t origin = at(list.origin[at(i)]);
      if (origin >= member_of_.size()) member_of_.resize(2 * origin, -1);
      member_of_[origin] = i;
    }
  }

  void add(const KeptSchedule::Colour& kept) {
    const int all = size_ > 4 ? 0 : (1 << size_) - 1;
    if ((kept.runs & (kept.is_added ? -1 : ~all)) != 0 || kept.tile < -1 || kept.tile >= tiles_) return;
    const std::size_t group = kept.runs != 0 ? 4 : 1;
    const int tile = kept.tile < 0 ? tiles_ : kept.tile;
    Colour colour{kept.runs, {}};
    first_ = seen_;
    for (std::size_t i = 0; i + group <= kept.constraints.size(); i += group)
      add_group(&kept.constraints[i], group, tile, colour);
    if (kept.runs != all) drop_rest(colour);
    if (colour.members.empty()) return;
    KeptColours::OfTile& colours = out_.of_tile[at(tile)];
    (kept.is_added ? colours.added : colours.first).push_back(std::move(colour));
  }

  KeptColours take() { return std::move(out_); }

 private:
  const int* stencil(int member) const { return &stencils_[at(member) * at(size_)]; }

  /// Adds constraints that are one group if all of them are there, and nothing stands against it.
  void add_group(const int* constraints, std::size_t count, int tile, Colour& colour) {
    std::array<int, 4> members{};
    for (std::size_t i = 0; i < count; ++i) {
      const int origin = constraints[i];
      members[i] = origin >= 0 && at(origin) < member_of_.size() ? member_of_[at(origin)] : -1;
      if (members[i] < 0 || out_.is_kept[at(members[i])] != 0 || tile_at(members[i]) != tile) return;
    }
    if (!is_contiguous(members, colour.runs)) return;
    for (std::size_t i = 0; i < count; ++i)
      if (!take_particles(members[i])) return;
    for (std::size_t i = 0; i < count; ++i) {
      out_.is_kept[at(members[i])] = 1;
      colour.members.push_back(members[i]);
    }
  }

  int tile_at(int member) const {
    const int* const particles = stencil(member);
    const int tile = tile_of_[at(particles[0])];
    for (int slot = 1; slot < size_; ++slot)
      if (tile_of_[at(particles[slot])] != tile) return tiles_;
    return tile;
  }

  bool is_contiguous(const std::array<int, 4>& members, int runs) const {
    for (int slot = 0; slot < size_ && runs != 0; ++slot)
      for (int l = 1; l < 4 && (runs >> slot & 1) != 0; ++l)
        if (stencil(members[at(l)])[slot] != stencil(members[0])[slot] + l) return false;
    return true;
  }

  /// False if another constraint of this colour has one of the particles. A constraint may have a particle twice.
  bool take_particles(int member) {
    const int number = seen_++;
    for (int slot = 0; slot < size_; ++slot) {
      int& last = last_[at(stencil(member)[slot])];
      if (last >= first_ && last != number) return false;
      last = number;
    }
    return true;
  }

  /// Groups that are contiguous in some slots alone fill whole batches.
  void drop_rest(Colour& colour) {
    if (colour.runs == 0) return;
    const std::size_t whole = colour.members.size() / batch_width * batch_width;
    for (std::size_t i = whole; i < colour.members.size(); ++i) out_.is_kept[at(colour.members[i])] = 0;
    colour.members.resize(whole);
  }

  const std::vector<int>& stencils_;
  int size_;
  const std::vector<int>& tile_of_;
  int tiles_;
  std::vector<int> member_of_;  ///< of the list, by number among the constraints of the type
  int seen_ = 0, first_ = 0;    ///< how many constraints were looked at; the first of the present colour
  std::vector<int> last_;       ///< of each particle the last of these that has it
  KeptColours out_;
};

}  // namespace

KeptColours keep_colours(const KeptSchedule& kept, ConstraintList& list, const std::vector<int>& tile_of, int tiles) {
  ColourKeeper keeper(list, tile_of, tiles);
  for (const KeptSchedule::Colour& colour : kept.colours)
    if (colour.type == list.type && colour.law == static_cast<int>(list.law)) keeper.add(colour);
  return keeper.take();
}

}  // namespace pliant
