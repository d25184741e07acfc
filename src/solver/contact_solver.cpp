#include "solver/contact_solver.h"

#include <algorithm>

namespace pliant {

namespace {

/// The colour number of contacts for which none of the 64 colours is free.
constexpr int tail_colour = 64;
/// Contacts per task, in whole batches. A colour with fewer contacts is done before other threads wake up.
constexpr int contacts_a_task = 512;

void project_sequentially(Contact* contacts, const std::int32_t* order, int first, int last, Record* displacements,
                          float yield) {
  for (int i = first; i < last; ++i) project_contact(contacts[order[i]], displacements, yield);
}

}  // namespace

const ContactKernels& contact_kernels_sequential() {
  static constexpr ContactKernels kernels{project_sequentially, nullptr};
  return kernels;
}

void ContactColours::colour(const std::vector<Contact>& contacts, std::size_t first, std::size_t last,
                            const Record* positions, std::size_t points) {
  if (taken_.size() < points) taken_.resize(points, 0);
  const std::size_t count = last - first;
  colour_.resize(count);
  start_.assign(tail_colour + 2, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& point = contacts[first + i].point;
    std::uint64_t taken = 0;
    bool moves[4];
    for (int k = 0; k < 4; ++k) {
      moves[k] = positions[point[k]].w > 0;
      if (moves[k]) taken |= taken_[point[k]];
    }
    const int colour = ~taken != 0 ? __builtin_ctzll(~taken) : tail_colour;
    colour_[i] = static_cast<std::uint8_t>(colour);
    ++start_[colour + 1];
    if (colour == tail_colour) continue;
    for (int k = 0; k < 4; ++k)
      if (moves[k]) taken_[point[k]] |= std::uint64_t{1} << colour;
  }
  for (int c = 0; c <= tail_colour; ++c) start_[c + 1] += start_[c];
  order_.resize(count);
  std::int32_t next[tail_colour + 1];
  std::copy(start_.begin(), start_.end() - 1, next);
  for (std::size_t i = 0; i < count; ++i) order_[next[colour_[i]]++] = static_cast<std::int32_t>(first + i);
  for (std::size_t i = first; i < last; ++i)
    for (const std::int32_t point : contacts[i].point) taken_[point] = 0;
}

ContactColours ContactColours::only(FunctionRef<bool(std::int32_t)> is_kept) const {
  ContactColours out;
  out.start_.assign(start_.size(), 0);
  for (std::size_t c = 0; c + 1 < start_.size(); ++c) {
    for (std::int32_t i = start_[c]; i < start_[c + 1]; ++i)
      if (is_kept(order_[i])) out.order_.push_back(order_[i]);
    out.start_[c + 1] = static_cast<std::int32_t>(out.order_.size());
  }
  return out;
}

void ContactSolver::begin(const ContactKernels& kernels, const std::vector<Contact>& contacts, std::size_t leading,
                          const Record* positions, std::size_t points) {
  kernels_ = &kernels;
  sections_[0].colour(contacts, 0, leading, positions, points);
  sections_[1].colour(contacts, leading, contacts.size(), positions, points);
}

ContactSolver ContactSolver::only(const std::vector<Contact>& contacts,
                                  FunctionRef<bool(const Contact&)> is_kept) const {
  ContactSolver out;
  out.kernels_ = kernels_;
  for (std::size_t k = 0; k < sections_.size(); ++k)
    out.sections_[k] =
        sections_[k].only([&](std::int32_t i) { return is_kept(contacts[static_cast<std::size_t>(i)]); });
  return out;
}

void ContactSolver::for_ranges(Executor& executor, const char* name, const ContactColours& colours,
                               FunctionRef<void(int, int)> body, FunctionRef<void(int, int)> tail) const {
  const std::vector<std::int32_t>& start = colours.start();
  const auto tasks = [&](int c) { return executor.threads() == 1 ? 1 : (start[c + 1] - start[c]) / contacts_a_task; };
  for (int c = 0; c < tail_colour && start[c] < start.back();) {
    if (const int shared = tasks(c); shared > 1) {
      executor.parallel_for(name, shared, [&](int task) {
        const int from = start[c] + task * contacts_a_task;
        body(from, task + 1 == shared ? start[c + 1] : from + contacts_a_task);
      });
      ++c;
      continue;
    }
    Stopwatch watch(executor.timings(), name);
    for (; c < tail_colour && start[c] < start.back() && tasks(c) <= 1; ++c) body(start[c], start[c + 1]);
  }
  tail(start[tail_colour], start.back());
}

void ContactSolver::project(Executor& executor, const char* name, std::vector<Contact>& contacts, Record* displacements,
                            float yield) const {
  if (contacts.empty()) return;
  for (const ContactColours& colours : sections_) {
    if (colours.order().empty()) continue;
    const std::int32_t* order = colours.order().data();
    for_ranges(
        executor, name, colours,
        [&](int first, int last) { kernels_->project(contacts.data(), order, first, last, displacements, yield); },
        [&](int first, int last) { project_sequentially(contacts.data(), order, first, last, displacements, yield); });
  }
}

void ContactSolver::for_each(Executor& executor, const char* name, const std::vector<Contact>& contacts,
                             FunctionRef<void(const Contact&)> answer) const {
  if (contacts.empty()) return;
  for (const ContactColours& colours : sections_) {
    if (colours.order().empty()) continue;
    const auto range = [&](int first, int last) {
      for (int i = first; i < last; ++i) answer(contacts[colours.order()[i]]);
    };
    for_ranges(executor, name, colours, range, range);
  }
}

}  // namespace pliant
