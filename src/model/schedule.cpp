#include "model/schedule.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>

#include "constraints/gives_shape.h"
#include "constraints/registry.h"
#include "model/fill_pool.h"
#include "model/keep_schedule.h"
#include "model/tied_bodies.h"
#include "topology/colouring.h"

namespace pliant {

namespace {

constexpr int batches_per_inter_tile_task = 32, batches_per_stencil_task = 4;

/// Replaces user indices of particles by storage indices, and orders each stencil as its type's `canonical` does.
void renumber(ConstraintList& list, const std::vector<int>& place) {
  const int particles = static_cast<int>(place.size());
  std::vector<int>& stencils = list.stencils.own();
  for (int& number : stencils) number = number < particles ? place[number] : number;  // frames are not reordered
  const auto canonical = constraint_type(list.type).canonical;
  if (canonical == nullptr) return;
  std::array<float, most_rest_fields> rest{};
  const auto fields = static_cast<std::size_t>(list.fields);
  for (std::size_t i = 0; i < static_cast<std::size_t>(list.count()); ++i) {
    for (std::size_t field = 0; field < fields; ++field) rest[field] = list.rest[i * fields + field];
    canonical(&stencils[i * static_cast<std::size_t>(list.size)], rest.data());
    for (std::size_t field = 0; field < fields; ++field) list.rest.set(i * fields + field, rest[field]);
  }
}

/// The constraints of a list, grouped by the tile that contains all their particles; inter-tile constraints come last.
struct ByTile {
  std::vector<int> begin;  ///< first member of each tile, then of the inter-tile ones; one more at the end
  std::vector<int> members;

  std::vector<int> of(int tile) const { return {members.begin() + begin[tile], members.begin() + begin[tile + 1]}; }
};

ByTile split_by_tile(ConstraintList& list, const std::vector<int>& tile_of, int tiles) {
  const std::vector<int>& stencils = list.stencils.own();
  const auto tile_at = [&](int i) {
    const int* stencil = &stencils[static_cast<std::size_t>(i) * list.size];
    int tile = tile_of[stencil[0]];
    for (int slot = 1; slot < list.size; ++slot) {
      if (tile_of[stencil[slot]] != tile) tile = tiles;
    }
    return tile;
  };
  ByTile split;
  split.begin.assign(static_cast<std::size_t>(tiles) + 2, 0);
  for (int i = 0; i < list.count(); ++i) ++split.begin[tile_at(i) + 1];
  std::partial_sum(split.begin.begin(), split.begin.end(), split.begin.begin());
  split.members.resize(static_cast<std::size_t>(list.count()));
  std::vector<int> next(split.begin.begin(), split.begin.end() - 1);
  for (int i = 0; i < list.count(); ++i) split.members[next[tile_at(i)]++] = i;
  return split;
}

/// The constraints in the lanes of a batch. With groups of four, lane 4 l + j has member l of group j (see
/// math/wide.h). Lanes beyond the last constraint repeat the first one; they are read, but never written.
struct BatchMembers {
  std::array<int, batch_width> member{};
  std::array<bool, batch_width> is_valid{};

  BatchMembers(const Colour& colour, int batch) {
    const auto first = static_cast<std::size_t>(batch) * batch_width;
    for (std::size_t lane = 0; lane < batch_width; ++lane) {
      const std::size_t position = first + (colour.runs != 0 ? 4 * (lane % 4) + lane / 4 : lane);
      is_valid[lane] = position < colour.members.size();
      member[lane] = colour.members[is_valid[lane] ? position : first];
    }
  }
};

void append_batch(const ConstraintList& list, const std::vector<Row>& rows, const Colour& colour, int batch,
                  Pool& pool) {
  const BatchMembers members(colour, batch);
  const std::size_t block = pool.blocks.size();
  pool.blocks.resize(block + pool.block_floats);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (pool.row_offset[row] < 0) continue;
    float* const to = &pool.blocks[block + pool.row_offset[row]];
    for (std::size_t lane = 0; lane < batch_width; ++lane) to[lane] = rows[row].at(members.member[lane]);
  }
  for (std::size_t lane = 0; lane < batch_width; ++lane)
    pool.origin.push_back(members.is_valid[lane] ? list.origin[static_cast<std::size_t>(members.member[lane])] : -1);
  for (int slot = 0; slot < list.size; ++slot) {
    const std::size_t lanes = (colour.runs >> slot & 1) != 0 ? 4 : batch_width;
    for (std::size_t lane = 0; lane < lanes; ++lane)
      pool.indices.push_back(list.stencils[static_cast<std::size_t>(members.member[lane]) * list.size + slot]);
  }
  ++pool.batches;
}

/// Appends batches [first, last) of a colour to a pool, and returns them as a segment.
Segment append_segment(const ConstraintList& list, const std::vector<Row>& rows, const Colour& colour, int first,
                       int last, int pool_number, Pool& pool) {
  const int count = static_cast<int>(colour.members.size());
  Segment segment;
  segment.pool = pool_number;
  segment.runs = colour.runs;
  segment.first_batch = pool.batches;
  segment.batches = last - first;
  const int in_last = std::min(batch_width, count - (last - 1) * batch_width);
  segment.last_count = colour.runs != 0 ? in_last / 4 : in_last;
  segment.index_offset = static_cast<std::int64_t>(pool.indices.size());
  for (int batch = first; batch < last; ++batch) append_batch(list, rows, colour, batch, pool);
  return segment;
}

/// Appends a colour in segments of at most `largest` batches. Inter-tile constraints use several, because threads share
/// them by segment.
void append_colour(const ConstraintList& list, const Colour& colour, int largest, int pool_number, Pool& pool,
                   std::vector<Segment>& segments) {
  const int batches = (static_cast<int>(colour.members.size()) + batch_width - 1) / batch_width;
  const std::vector<Row> rows = rows_of(list);
  for (int first = 0; first < batches;) {
    const int last = first + std::min(batches - first, largest);
    segments.push_back(append_segment(list, rows, colour, first, last, pool_number, pool));
    first = last;
  }
}

/// Gives each constraint a colour of its own, which keeps the order of the list.
std::vector<Colour> one_by_one(const std::vector<int>& members) {
  std::vector<Colour> colours;
  colours.reserve(members.size());
  for (int member : members) colours.push_back({0, {member}});
  return colours;
}

/// The segments of one constraint list: tile by tile, then inter-tile constraints by colour.
struct ListSchedule {
  std::vector<Segment> segments;
  std::vector<char> are_added;            ///< 1 for each segment that was coloured after an edit
  std::vector<int> tile_end, colour_end;  ///< one past the last segment of each tile; of each inter-tile colour
  bool takes_turns = false;               ///< true: the list is of a solid, whose lists take turns
};

/// Reserves more than needed: reserved pages that are never written cost no memory, but a growing array is copied.
void reserve(const ConstraintList& list, Pool& pool) {
  const std::size_t lanes = static_cast<std::size_t>(list.count()) * 5 / 4 + batch_width;
  pool.indices.reserve(lanes * static_cast<std::size_t>(list.size));
  pool.blocks.reserve(lanes / batch_width * static_cast<std::size_t>(pool.block_floats));
  pool.origin.reserve(lanes);
}

/// What all lists of an object are scheduled with.
struct Scheduler {
  const std::vector<int>& tile_of;  ///< of each particle, by its place in storage
  int tiles = 0;
  bool in_given_order = false;
  const KeptSchedule* kept = nullptr;
  Colouring colouring;

  ListSchedule schedule(ConstraintList& list, int number, Pool& pool) {
    ListSchedule out;
    out.takes_turns = !in_given_order && belongs_to_solid(list.type);
    const ByTile split = split_by_tile(list, tile_of, tiles);
    KeptColours colours;
    if (kept != nullptr) colours = keep_colours(*kept, list, tile_of, tiles);
    reserve(list, pool);
    for (int t = 0; t <= tiles; ++t) {
      std::vector<int> members = split.of(t);
      const int largest = t == tiles ? batches_per_inter_tile_task : 1 << 30;
      const auto append = [&](const std::vector<Colour>& all, bool are_added) {
        for (const Colour& colour : all) {
          append_colour(list, colour, largest, number, pool, out.segments);
          out.are_added.resize(out.segments.size(), are_added ? 1 : 0);
          if (t == tiles) out.colour_end.push_back(static_cast<int>(out.segments.size()));
        }
      };
      if (kept != nullptr) {
        KeptColours::OfTile& of_tile = colours.of_tile[static_cast<std::size_t>(t)];
        std::erase_if(members, [&](int member) { return colours.is_kept[static_cast<std::size_t>(member)] != 0; });
        colouring.extend(list.stencils.own(), list.size, members, of_tile.added);
        append(of_tile.first, false);
        append(of_tile.added, true);
      } else {
        append(in_given_order ? one_by_one(members) : colouring.colour(list.stencils.own(), list.size, members), false);
      }
      if (t < tiles) out.tile_end.push_back(static_cast<int>(out.segments.size()));
    }
    if (pool.indices.capacity() > 2 * pool.indices.size()) pool.indices.shrink_to_fit();  // most slots are contiguous
    return out;
  }
};

/// Segments of a list up to `end`, and where they stand among those of all lists.
struct Piece {
  double place;
  std::size_t list;
  int end;
};

/// Adds the pieces of a list, which end at `ends`. Lists come one after another; but those of a solid take turns, in
/// proportion to their pieces, at the place `of_solid`. With all volumes after all shear, surface particles are moved
/// too far by what comes first (docs/internals/solids.md). Pieces that an edit added come last, so that the others keep
/// their order.
void add_pieces(const ListSchedule& from, std::size_t list, std::size_t of_solid, const std::vector<int>& ends,
                std::vector<Piece>& out) {
  constexpr double last_of_all = 1 - 1e-12;
  const auto is_added = [&](int end) { return from.are_added[static_cast<std::size_t>(end) - 1] != 0; };
  const auto kept =
      static_cast<double>(std::count_if(ends.begin(), ends.end(), [&](int end) { return !is_added(end); }));
  double number = 0.5;
  for (const int end : ends) {
    double place = static_cast<double>(list);
    if (from.takes_turns) place = static_cast<double>(of_solid) + (is_added(end) ? last_of_all : number++ / kept);
    out.push_back({place, list, end});
  }
}

/// The pieces of all lists in order; `ends(list)` are where those of a list end.
template <class Ends>
std::vector<Piece> in_order(const std::vector<ListSchedule>& schedules, const Ends& ends) {
  std::vector<Piece> pieces;
  std::size_t of_solid = 0;
  while (of_solid < schedules.size() && !schedules[of_solid].takes_turns) ++of_solid;
  for (std::size_t i = 0; i < schedules.size(); ++i) add_pieces(schedules[i], i, of_solid, ends(i), pieces);
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.place < b.place; });
  return pieces;
}

/// Merges the segments of all lists: tile by tile, then inter-tile colour by colour.
void merge(const std::vector<ListSchedule>& schedules, CompiledObject& out) {
  std::vector<int> next(schedules.size(), 0);
  const auto append = [&](const Piece& piece) {
    const ListSchedule& from = schedules[piece.list];
    int& begin = next[piece.list];
    out.segments.insert(out.segments.end(), from.segments.begin() + begin, from.segments.begin() + piece.end);
    const auto added = from.are_added.begin();
    if (out.additions.are_used)
      out.additions.segments.insert(out.additions.segments.end(), added + begin, added + piece.end);
    begin = piece.end;
  };
  for (std::size_t t = 0; t < out.tiles.size(); ++t) {
    out.tiles[t].first_segment = static_cast<int>(out.segments.size());
    const auto ends = [&](std::size_t i) {
      std::vector<int> each(
          schedules[i].tile_end.empty() ? 0 : static_cast<std::size_t>(schedules[i].tile_end[t] - next[i]));
      std::iota(each.begin(), each.end(), next[i] + 1);
      return each;
    };
    for (const Piece& piece : in_order(schedules, ends)) append(piece);
    out.tiles[t].last_segment = static_cast<int>(out.segments.size());
  }
  out.phases.push_back({Driver::tile, 0, static_cast<int>(out.tiles.size())});
  for (const Piece& piece : in_order(schedules, [&](std::size_t i) { return schedules[i].colour_end; })) {
    const int first = static_cast<int>(out.segments.size());
    append(piece);
    out.phases.push_back({Driver::inter_tile, first, static_cast<int>(out.segments.size())});
  }
}

/// True if a later step of compile() reads the list: chains, stencils, or, for distance constraints, tethers or
/// multigrid.
bool is_needed_later(const ConstraintList& list, bool keeps_lengths) {
  return list.chained || !list.in_lanes || (is_length(list.type) && keeps_lengths);
}

}  // namespace

void schedule(std::vector<ConstraintList>& lists, const std::vector<int>& tile, bool in_given_order, bool keeps_lengths,
              const KeptSchedule* kept, CompiledObject& out) {
  std::vector<int> tile_of(tile.size());  // tile of each particle, by storage index
  for (std::size_t storage = 0; storage < tile.size(); ++storage) tile_of[storage] = tile[out.order[storage]];
  std::vector<ListSchedule> schedules(lists.size());
  Scheduler scheduler{tile_of, static_cast<int>(out.tiles.size()), in_given_order, kept, Colouring(out.particles)};
  for (std::size_t i = 0; i < lists.size(); ++i) {
    ConstraintList& list = lists[i];
    renumber(list, out.place);
    out.pools.push_back(make_pool(list));
    if (!list.chained && list.in_lanes) schedules[i] = scheduler.schedule(list, static_cast<int>(i), out.pools[i]);
    if (!is_needed_later(list, keeps_lengths)) list = list.empty();
  }
  merge(schedules, out);
}

namespace {

/// Appends the ties of bodies that have many, each as a segment, and returns the other members of the list.
std::vector<int> append_tied_bodies(const ConstraintList& list, int pool, CompiledObject& out) {
  const TiedBodies tied = find_tied_bodies(list, out.particles);
  for (const std::vector<TiesOfBody>& colour : tied.colours) {
    const int first = static_cast<int>(out.segments.size());
    for (const TiesOfBody& members : colour) {
      append_colour(list, {0, members}, std::numeric_limits<int>::max(), pool, out.pools[pool], out.segments);
      out.segments.back().is_of_one_body = true;
    }
    out.phases.push_back({Driver::stencil, first, static_cast<int>(out.segments.size())});
  }
  return tied.singles;
}

}  // namespace

void schedule_stencils(std::vector<ConstraintList>& lists, bool in_given_order, CompiledObject& out) {
  Colouring colouring(out.particles + static_cast<int>(out.frames.size()));
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const ConstraintList& list = lists[i];
    const int pool = static_cast<int>(i);
    if (list.in_lanes) continue;
    std::vector<int> members(static_cast<std::size_t>(list.count()));
    std::iota(members.begin(), members.end(), 0);
    if (constraint_type(list.type).is_tie && !in_given_order) members = append_tied_bodies(list, pool, out);
    const std::vector<Colour> colours =
        in_given_order ? one_by_one(members) : colouring.colour_singly(lists[i].stencils.own(), list.size, members);
    for (const Colour& colour : colours) {
      const int first = static_cast<int>(out.segments.size());
      append_colour(list, colour, batches_per_stencil_task, pool, out.pools[i], out.segments);
      out.phases.push_back({Driver::stencil, first, static_cast<int>(out.segments.size())});
    }
  }
}

}  // namespace pliant
