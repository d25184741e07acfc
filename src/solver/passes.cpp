#include "solver/passes.h"

#include <utility>

#include "solver/volume.h"

namespace pliant {

namespace {

/// Below this many batches waking other threads takes longer than a colour of inter-tile constraints.
constexpr int fewest_batches_to_share = 96;

/// A contact found during the solve counts from this share of the thickness on. A shallower one is pushed out in the next
/// substep: pushed at once, cloth at rest on a floor moves two to four times as much.
constexpr float least_depth = 0.25f;

void sweep_segments(const Substep& s, int object, int first, int last, bool first_pass) {
  const CompiledObject& from = s.model.objects[object];
  const StepKernels& kernels = from.sweep == Sweep::sequential ? step_kernels_sequential() : s.kernels;
  const auto sweep = s.context.options.relaxation == 1 ? kernels.sweep : kernels.sweep_general;
  sweep(from.pools.data(), from.segments.data() + first, from.segments.data() + last, arguments(s, object, first_pass));
}

/// Grows the tile's bounds by where its particles are now.
void grow_bounds(const AdvanceArguments& a, PointBounds& bounds) {
  for (int i = a.first; i < a.last; ++i) {
    const Record &x = a.positions[i], &d = a.displacements[i];
    bounds.low = {min(bounds.low.x, x.x + d.x), min(bounds.low.y, x.y + d.y), min(bounds.low.z, x.z + d.z), 0};
    bounds.high = {max(bounds.high.x, x.x + d.x), max(bounds.high.y, x.y + d.y), max(bounds.high.z, x.z + d.z), 0};
  }
}

void find_more_in_tile(Substep& s, int task) {
  TileScratch& scratch = s.work.tiles[task];
  const AdvanceArguments a = particles(s, task);
  const CompiledObject& object = object_of(s, task);
  grow_bounds(a, scratch.bounds);
  scratch.more_contacts.clear();
  find_contacts({object, a, scratch.bounds, s.work.colliders, s.kernels.find_near}, scratch.near, scratch.more_contacts);
  const auto is_shallow = [&](const Contact& c) {
    const Record& d = a.displacements[c.point[0]];
    const float thickness = object.thickness + s.work.colliders[c.collider].thickness;
    return c.gap + dot(c.normal, Vec3f{d.x, d.y, d.z}) > -least_depth * thickness;
  };
  std::erase_if(scratch.more_contacts, is_shallow);
  if (scratch.more_contacts.empty()) return;
  merge_contacts(scratch.contacts, scratch.more_contacts, scratch.all_contacts);
  std::swap(scratch.contacts, scratch.all_contacts);
}

}  // namespace

/// The constraints of a segment share no particle and have no order.
void sweep_tile(const Substep& s, int task, bool first_pass, Order order) {
  const int object = s.model.tiles[task].object;
  const Tile& tile = tile_of(s, task);
  if (order == Order::forward) return sweep_segments(s, object, tile.first_segment, tile.last_segment, first_pass);
  for (int i = tile.last_segment; i-- > tile.first_segment;) sweep_segments(s, object, i, i + 1, first_pass);
}

void sweep_tiles(Substep& s, bool first_pass, Order order) {
  for_swept_tiles(s, "solve: tiles", [&](int task) { sweep_tile(s, task, first_pass, order); });
}

void sweep_inter_tile(Substep& s, bool first_pass, Order order) {
  for_inter_tile(s, order, [&](int object, const Segment* segment) {
    const int number = static_cast<int>(segment - s.model.objects[object].segments.data());
    sweep_segments(s, object, number, number + 1, first_pass);
  });
}

void for_inter_tile(Substep& s, Order order, FunctionRef<void(int, const Segment*)> body) {
  const std::size_t phases = s.model.inter_tile.size();
  for (std::size_t p = 0; p < phases; ++p) {
    const InterTilePhase& phase = s.model.inter_tile[order == Order::forward ? p : phases - 1 - p];
    const auto sweep_task = [&](int i) {
      const InterTilePhase::Task& task = phase.tasks[i];
      if (is_swept(s, task.object)) body(task.object, s.model.objects[task.object].segments.data() + task.segment);
    };
    const int tasks = static_cast<int>(phase.tasks.size());
    if (phase.batches >= fewest_batches_to_share) {
      s.context.executor.parallel_for("solve: inter-tile constraints", tasks, sweep_task);
    } else {
      Stopwatch watch(s.context.executor.timings(), "solve: inter-tile constraints");
      for (int i = 0; i < tasks; ++i) sweep_task(i);
    }
  }
}

void sweep_volumes(Substep& s, bool first_pass) {
  const auto of_object = [&](int object) { return arguments(s, object, first_pass); };
  const auto takes_part = [&](int object) { return s.model.objects[object].has_volume && is_swept(s, object); };
  project_volumes(s.model, s.work, s.context.executor, of_object, takes_part);
}

namespace {

/// Those of the objects that are swept: objects share no contact here, so each gets the bits that it gets alone.
void sweep_shape_contacts(Substep& s) {
  constexpr const char* name = "solve: contacts";
  std::vector<Contact>& contacts = s.work.shape_contacts.contacts();
  Record* displacements = s.work.displacements.data();
  const ContactSolver& solver = s.work.shape_contact_solver;
  if (s.group == nullptr || s.work.sweeps.size() == 1)
    return solver.project(s.context.executor, name, contacts, displacements);
  solver.for_each(s.context.executor, name, contacts, [&](const Contact& contact) {
    if (is_swept(s, s.model.object_of(contact.point[0])))
      project_contact(contacts[static_cast<std::size_t>(&contact - contacts.data())], displacements);
  });
}

}  // namespace

void sweep_contacts(Substep& s) {
  if (s.work.colliders.empty()) return;
  sweep_shape_contacts(s);
  for_swept_tiles(s, "solve: contacts", [&](int task) {
    std::vector<Contact>& contacts = s.work.tiles[task].contacts;
    if (!contacts.empty()) project_contacts(contacts, arguments(s, s.model.tiles[task].object, false));
  });
}

void sweep_pairs(Substep& s) {
  if (s.has_pairs())
    s.work.contact_solver.project(s.context.executor, "solve: contacts among surfaces", s.work.pairs->contacts(),
                                  s.work.displacements.data());
}

void find_more_contacts(Substep& s) {
  if (s.work.colliders.empty()) return;
  for_swept_tiles(s, "solve: contacts", [&](int task) { find_more_in_tile(s, task); });
}

}  // namespace pliant
