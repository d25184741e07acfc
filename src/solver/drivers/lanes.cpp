#include "solver/drivers/lanes.h"

#include <algorithm>
#include <numeric>

#include "constraints/gives_shape.h"
#include "core/at.h"
#include "solver/contact_kernels.h"
#include "solver/drivers/held.h"

namespace pliant {

namespace {

void project_segments(const Substep& s, int object, int first, int last, bool first_pass) {
  const CompiledObject& from = s.model.objects[object];
  const SweepKernels& kernels = from.sweep == Sweep::sequential ? sweep_kernels_sequential() : s.kernels;
  const auto sweep = s.context.options.relaxation == 1 ? kernels.sweep : &sweep_general;
  sweep(from.pools.data(), from.segments.data() + first, from.segments.data() + last, arguments(s, object, first_pass));
}

/// Calls body for the segments of an inter-tile phase. Phases with little work are not timed here, but by an
/// InterTileTimer.
void for_segments(Substep& s, const Phase& phase, FunctionRef<void(int, const Segment*)> body) {
  const char* name = phase.work < fewest_inter_tile_batches ? nullptr : inter_tile_name;
  for_tasks(s, phase, name, fewest_inter_tile_batches,
            [&](const Task& task) { body(task.object, s.model.objects[task.object].segments.data() + task.item); });
}

/// In how many pieces the constraints of a solid's tile are projected where it touches a collider. More leave thin
/// slabs too stiff and fewer too soft (docs/internals/solids.md).
constexpr int pieces_in_contact = 4;

/// True if contacts take turns with the constraints of an object. If they only came last, they would compress what
/// stands on a collider a second time, by all that its constraints push through the collider in one pass.
bool takes_turns_with_contacts(const Substep& s, int object) {
  const CompiledObject& of = s.model.objects[object];
  if (of.volume.keeps_momentum || !(arguments(s, object, false).lead > 0)) return false;
  return std::any_of(of.pools.begin(), of.pools.end(), [](const Pool& pool) { return belongs_to_solid(pool.type); });
}

/// Projects a tile's contacts in lanes, those of one collider at a time, because they share no particle.
void project_contacts_in_lanes(const Substep& s, int task) {
  std::vector<Contact>& contacts = s.work.tiles[task].contacts;
  Record* displacements = particles(s, task).displacements;
  static constexpr std::int32_t order[batch_width] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const int count = static_cast<int>(contacts.size());
  for (int first = 0, last = 0; first < count; first = last) {
    const std::int32_t collider = contacts[at(first)].collider;
    while (last < count && last < first + batch_width && contacts[at(last)].collider == collider) ++last;
    s.kernels.contacts.project(contacts.data() + first, order, 0, last - first, displacements, 0);
  }
}

/// A range of segments.
struct SegmentRange {
  int first = 0, last = 0;
};

/// The segments of a tile without those of attachments that follow the sweep, which are the first.
SegmentRange swept_of(const CompiledObject& of, const Tile& tile) {
  int first = tile.first_segment;
  while (first < tile.last_segment && of.segments[at(first)].pool == of.held.pool) ++first;
  return {first, tile.last_segment};
}

/// Projects segments of a tile in pieces of about as many batches, each followed by the tile's contacts with
/// colliders. Those that follow the last piece are left to their own driver, unless inter-tile constraints come first.
void project_with_contacts(const Substep& s, int task, const SegmentRange& swept, bool first_pass) {
  const int object = s.model.tiles()[task].object;
  const std::vector<Segment>& segments = s.model.objects[object].segments;
  const bool has_inter_tile = s.model.objects[object].tiles.size() > 1;
  const auto add_batches = [](int sum, const Segment& segment) { return sum + segment.batches; };
  const int all = std::accumulate(segments.begin() + swept.first, segments.begin() + swept.last, 0, add_batches);
  int first = swept.first, done = 0;
  for (int piece = 1; piece <= pieces_in_contact; ++piece) {
    int last = first;
    for (; last < swept.last && pieces_in_contact * done < piece * all; ++last) done += segments[at(last)].batches;
    if (last == first) continue;
    project_segments(s, object, first, last, first_pass);
    first = last;
    if (last < swept.last || has_inter_tile) project_contacts_in_lanes(s, task);
  }
}

void project_forward(const Substep& s, int task, const SegmentRange& swept, bool first_pass) {
  const int object = s.model.tiles()[task].object;
  if (!s.work.tiles[task].contacts.empty() && takes_turns_with_contacts(s, object))
    return project_with_contacts(s, task, swept, first_pass);
  project_segments(s, object, swept.first, swept.last, first_pass);
}

}  // namespace

/// A backward walk visits the segments in reverse order. The order within a segment is irrelevant, because constraints
/// of a segment share no particle.
void project_tile(const Substep& s, int task, bool first_pass, Order order) {
  const int object = s.model.tiles()[task].object;
  const Tile& tile = tile_of(s, task);
  if (sweeps_held(s, object)) {
    hold_particles(s, object, tile);
    const HeldMasses masses(s, object, tile);
    return project_forward(s, task, swept_of(object_of(s, task), tile), first_pass);
  }
  if (order == Order::forward) return project_forward(s, task, {tile.first_segment, tile.last_segment}, first_pass);
  for (int i = tile.last_segment; i-- > tile.first_segment;) project_segments(s, object, i, i + 1, first_pass);
}

void project_tiles(Substep& s, const Phase& /*phase*/, const Pass& pass) {
  if (pass.first && s.sweeps_on_entry) return;  // predict ran the first pass on entry to each tile (stages/advance.cpp)
  for_swept_tiles(s, "solve: tiles", [&](int task) { project_tile(s, task, pass.first, pass.order); });
}

void project_inter_tile(Substep& s, const Phase& phase, const Pass& pass) {
  std::vector<HeldMasses> masses;
  for (const Task& task : phase.tasks) {
    const bool is_new = &task == phase.tasks.data() || (&task)[-1].object != task.object;
    if (is_new && is_swept(s, task.object) && sweeps_held(s, task.object))
      masses.emplace_back(s, task.object, 0, s.model.objects[task.object].particles);
  }
  for_segments(s, phase, [&](int object, const Segment* segment) {
    const int number = static_cast<int>(segment - s.model.objects[object].segments.data());
    project_segments(s, object, number, number + 1, pass.first);
  });
}

void for_inter_tile(Substep& s, FunctionRef<void(int, const Segment*)> body) {
  InterTileTimer timer(s);
  for (const Phase& phase : s.phases()) {
    timer.enter(phase);
    if (phase.driver == Driver::inter_tile) for_segments(s, phase, body);
  }
}

}  // namespace pliant
