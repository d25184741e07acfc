#include "solver/sweeps/jacobi.h"

#include "solver/drivers/lanes.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Copies positions with inverse masses multiplied by n, the number of constraints at the particle: each constraint
/// acts on an n-th of the mass.
void split_masses(const Tile& tile, const Record* positions, JacobiObject& object) {
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    object.positions[i] = positions[i];
    object.positions[i].w = positions[i].w * static_cast<float>(object.incidence.count(i));
  }
}

/// Adds to each particle's displacement the mean of its corrections, summed in ascending order.
void gather(const Tile& tile, const JacobiObject& object, Record* displacements) {
  for (int i = tile.first_particle; i < tile.last_particle; ++i) {
    const int count = object.incidence.count(i);
    if (count == 0) continue;
    Vec3f sum{};
    for (int k = object.incidence.begin[i]; k < object.incidence.begin[i + 1]; ++k) {
      const Record& correction = object.corrections[object.incidence.records[k]];
      sum += Vec3f{correction.x, correction.y, correction.z};
    }
    const float part = 1 / static_cast<float>(count);
    Record& d = displacements[i];
    d = {d.x + sum.x * part, d.y + sum.y * part, d.z + sum.z * part, 0};
  }
}

}  // namespace

void JacobiScratch::prepare(const SweepSetup& setup, int object) {
  const CompiledObject& from = setup.model.objects[object];
  objects.resize(setup.model.objects.size());
  JacobiObject& to = objects[object];
  to = {};
  if (!setup.has(object)) return;
  to.incidence = make_incidence(from);
  to.corrections.resize(to.incidence.pool_begin.back());
  for (std::size_t p = 0; p < from.pools.size(); ++p)
    to.correction_pointers.push_back(to.corrections.data() + to.incidence.pool_begin[p]);
  if (setup.options.sharing == SweepOptions::Sharing::split) {
    to.positions.resize(from.particles);
  } else {
    to.shares = averaging_shares(from, to.incidence);
    for (const AlignedVector<float>& values : to.shares) to.share_pointers.push_back(values.data());
  }
}

void iterate_jacobi(Substep& s, bool first) {
  std::vector<JacobiObject>& objects = static_cast<JacobiScratch&>(*s.group->scratch).objects;
  const Model& model = s.model;
  const auto work_of = [&](int task) -> JacobiObject& { return objects[model.tiles()[task].object]; };
  const auto arguments_of = [&](int number) {
    SweepArguments a = arguments(s, number, first);
    const JacobiObject& object = objects[number];
    if (!object.positions.empty()) a.positions = object.positions.data();
    if (!object.share_pointers.empty()) a.shares = object.share_pointers.data();
    a.corrections = object.correction_pointers.data();
    return a;
  };
  const auto displacements = [&](int task) { return arguments(s, model.tiles()[task].object, first).displacements; };

  if (first) {
    for_swept_tiles(s, "solve: split", [&](int task) {
      if (work_of(task).positions.empty()) return;
      split_masses(tile_of(s, task), arguments(s, model.tiles()[task].object, first).positions, work_of(task));
    });
  }
  for_swept_tiles(s, "solve: tiles", [&](int task) {
    const CompiledObject& object = object_of(s, task);
    sweep_general(object.pools.data(), object.segments.data() + tile_of(s, task).first_segment,
                  object.segments.data() + tile_of(s, task).last_segment, arguments_of(model.tiles()[task].object));
  });
  for_inter_tile(s, [&](int number, const Segment* segment) {
    sweep_general(model.objects[number].pools.data(), segment, segment + 1, arguments_of(number));
  });
  for_swept_tiles(s, "solve: gather", [&](int task) { gather(tile_of(s, task), work_of(task), displacements(task)); });
  walk(s, Driver::volume, {first});
}

}  // namespace pliant
