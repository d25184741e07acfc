#include "model/model.h"

#include <algorithm>
#include <utility>

#include "model/compile_flow.h"
#include "model/layout.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Orientation of unused frame records: the identity, which stays finite under prediction.
constexpr Record unrotated{0, 0, 0, 1};

/// A batch has sixteen constraints; shape matching takes about eight times as long for a particle.
int work_of(const CompiledCluster& cluster) { return 1 + (cluster.last - cluster.first) / 2; }

/// The cost of one item of a driver, in batches or chain steps.
int work_of(const CompiledObject& object, Driver driver, int item) {
  switch (driver) {
    case Driver::inter_tile:
    case Driver::stencil:
      return object.segments[item].batches;
    case Driver::chain:
      return object.chains[item].steps;
    case Driver::cluster:
      return work_of(object.clusters.clusters[item]);
    default:
      return 1;
  }
}

/// The tasks of an object in a phase. They are contiguous, because tasks are sorted by object.
auto tasks_of(std::vector<Task>& tasks, int object) {
  const auto before = [](const Task& task, int number) { return task.object < number; };
  const auto after = [](int number, const Task& task) { return number < task.object; };
  return std::make_pair(std::lower_bound(tasks.begin(), tasks.end(), object, before),
                        std::upper_bound(tasks.begin(), tasks.end(), object, after));
}

/// Finds the phase of a driver and colour. Inserts it if there is none.
Phase& phase_of(Driver driver, int colour, std::vector<Phase>& phases) {
  const auto at = std::find_if(phases.begin(), phases.end(), [&](const Phase& phase) {
    return std::pair(phase.driver, phase.colour) >= std::pair(driver, colour);
  });
  if (at != phases.end() && at->driver == driver && at->colour == colour) return *at;
  return *phases.insert(at, Phase{driver, colour});
}

void add_tasks(Model& model, int number) {
  const CompiledObject& object = model.objects[number];
  int colour = 0;
  for (std::size_t i = 0; i < object.phases.size(); ++i) {
    const ObjectPhase& from = object.phases[i];
    colour = i > 0 && object.phases[i - 1].driver == from.driver ? colour + 1 : 0;
    Phase& phase = phase_of(from.driver, colour, model.phases);
    std::vector<Task> tasks;
    for (int item = from.first; item < from.last; ++item) {
      tasks.push_back({number, item, work_of(object, from.driver, item)});
      phase.work += tasks.back().work;
    }
    phase.tasks.insert(tasks_of(phase.tasks, number).second, tasks.begin(), tasks.end());
  }
}

/// True if a phase must be kept: those of tiles and contacts stay even without tasks.
bool is_to_stay(const Phase& phase) {
  return !phase.tasks.empty() || phase.driver == Driver::tile || phase.driver == Driver::surface_contact ||
         phase.driver == Driver::collider_contact;
}

void remove_tasks(Model& model, int number) {
  for (Phase& phase : model.phases) {
    const auto [first, last] = tasks_of(phase.tasks, number);
    for (auto task = first; task != last; ++task) phase.work -= task->work;
    phase.tasks.erase(first, last);
  }
  std::erase_if(model.phases, [](const Phase& phase) { return !is_to_stay(phase); });
}

struct Range {
  int first = 0, size = 0, owner = 0;
};

/// Allocates blocks at given positions. It allocates the gaps between them too, and frees those at the end.
void occupy(std::vector<Range> ranges, BlockAllocator& blocks) {
  std::erase_if(ranges, [](const Range& range) { return range.size == 0; });
  std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.first < b.first; });
  std::vector<Range> gaps;
  for (const Range& range : ranges) {
    if (range.first < blocks.end())
      throw Error({}, "two of its objects overlap in the State", "give each a range of its own");
    if (range.first > blocks.end()) gaps.push_back({blocks.end(), range.first - blocks.end()});
    if (range.first > blocks.end()) blocks.allocate(range.first - blocks.end(), -1);
    blocks.allocate(range.size, range.owner);
  }
  for (const Range& gap : gaps) blocks.release(gap.first, gap.size);
}

}  // namespace

void lay_out(std::vector<CompiledObject> objects, const std::vector<ObjectPlace>& places, Model& model) {
  std::vector<Range> particles, frames;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const int number = static_cast<int>(i);
    model.first.push_back(places[i].is_free ? 0 : places[i].first);
    model.first_frame.push_back(places[i].is_free ? 0 : places[i].first_frame);
    model.generation.push_back(places[i].generation);
    if (places[i].is_free) {
      model.free_numbers.insert(number);
    } else {
      particles.push_back({places[i].first, objects[i].particles, number});
      frames.push_back({places[i].first_frame, static_cast<int>(objects[i].frames.size()), number});
    }
  }
  occupy(std::move(particles), model.blocks);
  occupy(std::move(frames), model.frame_blocks);
  model.objects = std::move(objects);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!places[i].is_free) add_tasks(model, static_cast<int>(i));
}

int Model::add(CompiledObject object) {
  int number = static_cast<int>(objects.size());
  if (free_numbers.empty()) {
    objects.emplace_back();
    first.push_back(0);
    first_frame.push_back(0);
    generation.push_back(0);
  } else {
    number = *free_numbers.begin();
    free_numbers.erase(free_numbers.begin());
  }
  first[number] = blocks.allocate(object.particles, number);
  first_frame[number] = frame_blocks.allocate(static_cast<int>(object.frames.size()), number);
  objects[number] = std::move(object);
  add_tasks(*this, number);
  return number;
}

void Model::remove(int object) {
  remove_tasks(*this, object);
  blocks.release(first[object], objects[object].particles);
  frame_blocks.release(first_frame[object], static_cast<int>(objects[object].frames.size()));
  objects[object] = {};
  first[object] = first_frame[object] = 0;
  ++generation[object];
  free_numbers.insert(object);
}

void Model::replace(int object, CompiledObject by) {
  remove_tasks(*this, object);
  if (by.particles != objects[object].particles) {
    blocks.release(first[object], objects[object].particles);
    first[object] = blocks.allocate(by.particles, object);
  }
  if (by.frames.size() != objects[object].frames.size()) {
    frame_blocks.release(first_frame[object], static_cast<int>(objects[object].frames.size()));
    first_frame[object] = frame_blocks.allocate(static_cast<int>(by.frames.size()), object);
  }
  objects[object] = std::move(by);
  ++generation[object];
  add_tasks(*this, object);
}

void resize_frames(const Model& model, FrameRecords& frames) {
  const auto count = static_cast<std::size_t>(model.frames());
  frames.orientations.resize(count, unrotated);
  frames.angular_velocities.resize(count);
  frames.inverse_inertias.resize(count);
}

void clear_frames(int first, int count, FrameRecords& frames) {
  std::fill_n(frames.orientations.begin() + first, count, unrotated);
  std::fill_n(frames.angular_velocities.begin() + first, count, Record{});
  std::fill_n(frames.inverse_inertias.begin() + first, count, Record{});
}

namespace {

/// Sets a channel of an object's particles. Channels are ordered by name, so that their order does not depend on that
/// of objects.
void fill_channel(const Model& model, int object, const char* name, float value, State& state) {
  auto channel =
      std::find_if(state.channels.begin(), state.channels.end(), [&](const Channel& one) { return one.name >= name; });
  if (channel == state.channels.end() || channel->name != name)
    channel = state.channels.insert(channel, {name, 1, std::vector<float>(state.positions.size(), 0.f)});
  std::fill_n(channel->values.begin() + model.first[object], model.objects[object].particles, value);
}

/// Particles are born when they are added; spare ones are not there yet.
void put_births(const Model& model, int object, State& state) {
  const CompiledObject& from = model.objects[object];
  if (state.births.empty() && !from.flow.is_used()) return;
  state.births.resize(static_cast<std::size_t>(model.particles()), 0.0);
  const auto first = static_cast<std::size_t>(model.first[object]);
  for (int i = 0; i < from.particles; ++i) {
    const bool is_there = !is_spare(from, i);
    state.births[first + static_cast<std::size_t>(i)] = is_there ? state.time : not_there;
    if (is_there) continue;
    state.positions[first + static_cast<std::size_t>(i)].w = 0;
    state.velocities[first + static_cast<std::size_t>(i)] = {};
  }
}

}  // namespace

void put_at_start(const Model& model, int object, State& state) {
  const CompiledObject& from = model.objects[object];
  const auto particles = static_cast<std::size_t>(model.particles());
  for (Records* records : {&state.positions, &state.remainders, &state.velocities}) records->resize(particles);
  if (state.blocks.size() <= static_cast<std::size_t>(object))
    state.blocks.resize(static_cast<std::size_t>(object) + 1);
  state.blocks[object] = {model.first[object], from.particles, model.generation[object]};
  resize_frames(model, state.frames);
  const auto put = [&](const Records& start, Records& all) {
    std::copy(start.begin(), start.end(), all.begin() + model.first_frame[object]);
  };
  put(from.frames.orientations, state.frames.orientations);
  put(from.frames.angular_velocities, state.frames.angular_velocities);
  put(from.frames.inverse_inertias, state.frames.inverse_inertias);
  std::copy(from.positions.begin(), from.positions.end(), state.positions.begin() + model.first[object]);
  std::fill_n(state.velocities.begin() + model.first[object], from.particles, Record{});
  std::copy(from.velocities.begin(), from.velocities.end(), state.velocities.begin() + model.first[object]);
  std::fill_n(state.remainders.begin() + model.first[object], from.particles, Record{});
  for (Channel& channel : state.channels)
    channel.values.resize(particles * static_cast<std::size_t>(channel.components));
  if (from.gas) fill_channel(model, object, temperature_channel, from.gas->temperature, state);
  if (from.tracers) fill_channel(model, object, age_channel, no_age, state);
  if (from.absorbency.is_used) fill_channel(model, object, water_channel, 0, state);
  put_births(model, object, state);
}

State initial_state(const Model& model) {
  State state;
  for (Records* records : {&state.positions, &state.remainders, &state.velocities}) records->reserve(model.particles());
  for (int object = 0; object < static_cast<int>(model.objects.size()); ++object) put_at_start(model, object, state);
  return state;
}

}  // namespace pliant
