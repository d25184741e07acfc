#include "model/model.h"

#include <algorithm>
#include <utility>

namespace pliant {

namespace {

/// Tasks stand in the order of their objects' numbers.
template <class Task>
auto tasks_of(std::vector<Task>& tasks, int object) {
  const auto before = [](const Task& task, int number) { return task.object < number; };
  const auto after = [](int number, const Task& task) { return number < task.object; };
  return std::make_pair(std::lower_bound(tasks.begin(), tasks.end(), object, before),
                        std::upper_bound(tasks.begin(), tasks.end(), object, after));
}

template <class Task>
void insert(const std::vector<Task>& some, int object, std::vector<Task>& tasks) {
  tasks.insert(tasks_of(tasks, object).second, some.begin(), some.end());
}

template <class Task>
void erase(std::vector<Task>& tasks, int object) {
  const auto [first, last] = tasks_of(tasks, object);
  tasks.erase(first, last);
}

std::vector<TileTask> tiles_of(const CompiledObject& object, int number) {
  std::vector<TileTask> tasks;
  for (int tile = 0; tile < static_cast<int>(object.tiles.size()); ++tile) tasks.push_back({number, tile});
  return tasks;
}

void add_straddlers(const CompiledObject& object, int number, std::vector<StraddlerPhase>& phases) {
  if (phases.size() < object.straddlers.size()) phases.resize(object.straddlers.size());
  for (std::size_t colour = 0; colour < object.straddlers.size(); ++colour) {
    std::vector<StraddlerPhase::Task> tasks;
    for (int s = object.straddlers[colour].first_segment; s < object.straddlers[colour].last_segment; ++s) {
      tasks.push_back({number, s});
      phases[colour].batches += object.segments[s].batches;
    }
    insert(tasks, number, phases[colour].tasks);
  }
}

void add_chains(const CompiledObject& object, int number, std::vector<ChainPhase>& phases) {
  if (phases.size() < object.chain_colours.size()) phases.resize(object.chain_colours.size());
  for (std::size_t colour = 0; colour < object.chain_colours.size(); ++colour) {
    std::vector<ChainPhase::Task> tasks;
    for (int b = object.chain_colours[colour].first_batch; b < object.chain_colours[colour].last_batch; ++b) {
      tasks.push_back({number, b});
      phases[colour].steps += object.chains[b].steps;
    }
    insert(tasks, number, phases[colour].tasks);
  }
}

/// Phases that nobody has tasks in any more are always the last ones: an object has tasks in all up to its own last.
template <class Phase>
void drop_empty(std::vector<Phase>& phases) {
  while (!phases.empty() && phases.back().tasks.empty()) phases.pop_back();
}

void add_tasks(Model& model, int number) {
  const CompiledObject& object = model.objects[number];
  insert(tiles_of(object, number), number, model.tiles);
  add_straddlers(object, number, model.straddlers);
  add_chains(object, number, model.chains);
}

void remove_tasks(Model& model, int number) {
  const CompiledObject& object = model.objects[number];
  erase(model.tiles, number);
  for (StraddlerPhase& phase : model.straddlers) {
    const auto [first, last] = tasks_of(phase.tasks, number);
    for (auto task = first; task != last; ++task) phase.batches -= object.segments[task->segment].batches;
    phase.tasks.erase(first, last);
  }
  for (ChainPhase& phase : model.chains) {
    const auto [first, last] = tasks_of(phase.tasks, number);
    for (auto task = first; task != last; ++task) phase.steps -= object.chains[task->batch].steps;
    phase.tasks.erase(first, last);
  }
  drop_empty(model.straddlers);
  drop_empty(model.chains);
}

}  // namespace

int Model::add(CompiledObject object) {
  int number = static_cast<int>(objects.size());
  if (free_numbers.empty()) {
    objects.emplace_back();
    first.push_back(0);
    generation.push_back(0);
  } else {
    number = *free_numbers.begin();
    free_numbers.erase(free_numbers.begin());
  }
  first[number] = blocks.allocate(object.particles, number);
  objects[number] = std::move(object);
  add_tasks(*this, number);
  return number;
}

void Model::remove(int object) {
  remove_tasks(*this, object);
  blocks.release(first[object], objects[object].particles);
  objects[object] = {};
  first[object] = 0;
  ++generation[object];
  free_numbers.insert(object);
}

void Model::replace(int object, CompiledObject by) {
  remove_tasks(*this, object);
  if (by.particles != objects[object].particles) {
    blocks.release(first[object], objects[object].particles);
    first[object] = blocks.allocate(by.particles, object);
  }
  objects[object] = std::move(by);
  ++generation[object];
  add_tasks(*this, object);
}

void put_at_start(const Model& model, int object, State& state) {
  const CompiledObject& from = model.objects[object];
  const auto particles = static_cast<std::size_t>(model.particles());
  for (Records* records : {&state.positions, &state.remainders, &state.velocities}) records->resize(particles);
  if (state.blocks.size() <= static_cast<std::size_t>(object)) state.blocks.resize(static_cast<std::size_t>(object) + 1);
  state.blocks[object] = {model.first[object], from.particles, model.generation[object]};
  std::copy(from.positions.begin(), from.positions.end(), state.positions.begin() + model.first[object]);
  std::copy(from.velocities.begin(), from.velocities.end(), state.velocities.begin() + model.first[object]);
  std::fill_n(state.remainders.begin() + model.first[object], from.particles, Record{});
}

State initial_state(const Model& model) {
  State state;
  for (Records* records : {&state.positions, &state.remainders, &state.velocities}) records->reserve(model.particles());
  for (int object = 0; object < static_cast<int>(model.objects.size()); ++object) put_at_start(model, object, state);
  return state;
}

}  // namespace pliant
