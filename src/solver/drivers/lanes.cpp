#include "solver/drivers/lanes.h"

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

}  // namespace

/// A backward walk visits the segments in reverse order. The order within a segment is irrelevant, because constraints
/// of a segment share no particle.
void project_tile(const Substep& s, int task, bool first_pass, Order order) {
  const int object = s.model.tiles()[task].object;
  const Tile& tile = tile_of(s, task);
  if (order == Order::forward) return project_segments(s, object, tile.first_segment, tile.last_segment, first_pass);
  for (int i = tile.last_segment; i-- > tile.first_segment;) project_segments(s, object, i, i + 1, first_pass);
}

void project_tiles(Substep& s, const Phase& /*phase*/, const Pass& pass) {
  if (pass.first && s.sweeps_on_entry) return;  // predict ran the first pass on entry to each tile (stages/advance.cpp)
  for_swept_tiles(s, "solve: tiles", [&](int task) { project_tile(s, task, pass.first, pass.order); });
}

void project_inter_tile(Substep& s, const Phase& phase, const Pass& pass) {
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
