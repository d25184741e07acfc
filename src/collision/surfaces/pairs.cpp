#include "collision/surfaces/pairs.h"

#include <algorithm>

#include "collision/surfaces/pair_bounds.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// A contact keeps no more than this share of the distance that its primitives have at rest.
constexpr double share_of_rest = 0.9;
/// Whoever looks at a list at all looks at what it will want to know in so many substeps.
constexpr float substeps_of_rest = 4;
/// Where something drives that moves by up to half a thickness in a substep, contacts keep this much of theirs.
constexpr float least_share_kept = 0.9f;

/// Whether a side that can't be pushed moves by more than what is lacked without harm.
bool is_driven(const PairContact& contact, const PairParticles& particles) {
  float way = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Record& d = particles.displacements[contact.vertex[i]];
    if (!(particles.positions[contact.vertex[i]].w > 0))
      way += contact.weight[i] * dot(contact.normal, Vec3f{d.x, d.y, d.z});
  }
  return -way > (1 - least_share_kept) * contact.thickness;
}

}  // namespace

/// Into task.near: pairs that can be nearer than `within` at the substep's end.
void PairSystem::collect_near(Bucket& bucket, Task& task, float within) const {
  task.near.clear();
  const float gone = moved(bucket) + moves(bucket);
  if (bucket.least_reach - gone > within) return;
  bucket.least_reach = out_of_reach;
  task.near.resize(bucket.reach.size());
  const int found = kernels_.collect(bucket.reach.data(), static_cast<int>(bucket.reach.size()), gone, within,
                                     task.near.data(), bucket.least_reach);
  task.near.resize(static_cast<std::size_t>(found));
}

/// Measures task.found and keeps what is nearer than `within`.
void PairSystem::keep_near(Bucket& bucket, float within, Task& task, const PairParticles& particles) {
  PairStencils stencils;
  PairBatch at;
  const float gone = moved(bucket);
  for (std::size_t i = 0; i < task.found.size(); i += 16) {
    const std::size_t count = std::min<std::size_t>(16, task.found.size() - i);
    for (std::size_t lane = 0; lane < 16; ++lane) put(stencils, lane, task.found[i + (lane < count ? lane : 0)].vertex);
    kernels_.distances(stencils, bucket.of_vertices ? 1 : 2, particles.positions, at);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const float reach = (at.at_least[lane] + gone) * sum_slack;
      if (reach > within) continue;
      bucket.least_reach = min(bucket.least_reach, reach);
      bucket.pairs.push_back(task.found[i + lane]);
      bucket.reach.push_back(reach);
    }
  }
}

/// Whether any of the surroundings can be nearer than `within` at the substep's end. Then their reach counts from now: moves
/// are taken off.
bool PairSystem::begin_anew(Surroundings& of, float within) {
  const float gone = moved(of);
  if (of.least_reach - (gone + moves(of)) > within) return false;
  for (int b = of.first_block; b < of.last_block; ++b) block_reach_[b] -= gone + 1e-6f * (abs(block_reach_[b]) + gone);
  of.listed_at = neighbours_[of.neighbours].moved;
  return true;
}

// ---------------------------------------------------------------- contacts

void PairSystem::measure(const Between& clusters, Batch& batch, const PairParticles& particles) const {
  kernels_.distances(batch.stencils, clusters.of_vertices ? 1 : 2, particles.positions, batch.at);
  find_paths(clusters, batch.stencils, particles, batch.paths);
}

/// A pair becomes a contact if its distance, less what it may fall by, is below what it keeps. `rest`: where to keep what its
/// distance at rest allows.
void PairSystem::detect_pair(const Between& clusters, const Batch& batch, int lane, float* rest, Task& task,
                             const PairParticles& particles) {
  const PairMaterial& between = material(clusters);
  const float distance = batch.at.distance[lane] * (1 - 1e-5f), nearest = distance - batch.paths.falls[lane];
  if (!(batch.at.distance[lane] > 0) || distance - moves(clusters) > between.thickness || nearest > between.thickness)
    return;
  const PairStencil four = stencil_at(batch.stencils, lane, clusters.of_vertices);
  if (is_tangled(four)) return;
  float of_rest = rest != nullptr ? *rest : -1;
  if (of_rest < 0) of_rest = static_cast<float>(share_of_rest * pair_distance(four, model_.rest.data()).distance);
  if (rest != nullptr) *rest = of_rest;
  PairMaterial kept = between;
  kept.thickness = min(kept.thickness, of_rest);
  if (nearest <= kept.thickness && batch.paths.apart[lane] <= kept.thickness)
    add_contact(four, batch.at, lane, kept, particles, task);
}

void PairSystem::detect_bucket(Bucket& bucket, Task& task, const PairParticles& particles) {
  collect_near(bucket, task, cull_slack * material(bucket).thickness);
  const float gone = moved(bucket);
  Batch batch;
  for (std::size_t i = 0; i < task.near.size(); i += 16) {
    const std::size_t count = std::min<std::size_t>(16, task.near.size() - i);
    for (std::size_t lane = 0; lane < 16; ++lane)
      put(batch.stencils, lane, bucket.pairs[task.near[i + (lane < count ? lane : 0)]].vertex);
    measure(bucket, batch, particles);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const std::int32_t number = task.near[i + lane];
      const float reach = (batch.at.at_least[lane] + gone) * sum_slack;
      bucket.reach[number] = reach;
      bucket.least_reach = min(bucket.least_reach, reach);
      detect_pair(bucket, batch, static_cast<int>(lane), &bucket.pairs[number].rest, task, particles);
    }
  }
}

/// Whoever looks at surroundings at all looks at all that will be due in some substeps, so as not to come again in the next.
void PairSystem::detect_surroundings(Surroundings& of, Task& task, const PairParticles& particles) {
  const float within = cull_slack * material(of).thickness;
  if (!begin_anew(of, within)) return;
  const float due = within + (1 + substeps_of_rest) * moves(of);
  const int first_side = of.of_vertices ? 1 : 2;
  of.least_reach = out_of_reach;
  for (int b = of.first_block; b < of.last_block; ++b) {
    if (block_reach_[b] <= due) {
      const float least = kernels_.least_distance(blocks_[b], first_side, particles.positions);
      block_reach_[b] = least * sum_slack;
      if (least - moves(of) <= within) detect_block(of, b, task, particles);
    }
    of.least_reach = min(of.least_reach, block_reach_[b]);
  }
}

void PairSystem::detect_block(const Surroundings& of, int block, Task& task, const PairParticles& particles) {
  Batch batch;
  batch.stencils = blocks_[block];
  measure(of, batch, particles);
  const int count = std::min(16, of.pairs - 16 * (block - of.first_block));
  for (int lane = 0; lane < count; ++lane) detect_pair(of, batch, lane, nullptr, task, particles);
}

void PairSystem::add_contact(const PairStencil& four, const PairBatch& at, int lane, const PairMaterial& material,
                             const PairParticles& particles, Task& task) {
  PairContact contact = make_contact(four, at, lane, material, particles.h);
  if (material.restitution > 0)
    contact.approach = approach_of(contact, particles.displacements, particles.remainders, particles.h);
  task.contacts.push_back(contact);
}

void PairSystem::detect(Executor& executor, const PairParticles& particles) {
  contacts_.clear();
  if (untangler_)
    untangler_->push(model_.untangling_speed * particles.h, particles.h, particles.displacements, particles.remainders);
  measure_moves(executor, particles);
  if (!is_bounded_) return;  // the end of the substep says so
  bring_up_to_date(executor, particles);
  executor.parallel_for("detect contacts", static_cast<int>(tasks_.size()), [&](int number) {
    Task& task = tasks_[number];
    task.contacts.clear();
    for (int s = task.first_surroundings; s < task.last_surroundings; ++s)
      detect_surroundings(surroundings_[s], task, particles);
    task.contacts_of_surroundings = task.contacts.size();
    for (int b = task.first; b < task.last; ++b) detect_bucket(buckets_[b], task, particles);
  });
  // Tasks are cut by how many buckets there are: all surroundings come first.
  for (const Task& task : tasks_)
    contacts_.insert(contacts_.end(), task.contacts.begin(),
                     task.contacts.begin() + static_cast<std::ptrdiff_t>(task.contacts_of_surroundings));
  for (const Task& task : tasks_)
    contacts_.insert(contacts_.end(), task.contacts.begin() + static_cast<std::ptrdiff_t>(task.contacts_of_surroundings),
                     task.contacts.end());
}

void PairSystem::project(const PairParticles& particles) {
  for (PairContact& contact : contacts_)
    project_contact(contact, particles.positions, particles.remainders, particles.displacements);
}

/// It is the contacts behind that matter as much as those with what drives: a move that the filter shortens for one of them is no
/// longer out of the way.
bool PairSystem::is_overrun(const PairParticles& particles) const {
  const auto lacks = [&](const PairContact& contact) {
    return overlap_of(contact, particles.displacements) > (1 - least_share_kept) * contact.thickness;
  };
  const auto is_driven_here = [&](const PairContact& contact) { return is_driven(contact, particles); };
  return std::any_of(contacts_.begin(), contacts_.end(), is_driven_here) &&
         std::any_of(contacts_.begin(), contacts_.end(), lacks);
}

void PairSystem::measure_overlaps(const PairParticles& particles) {
  counts_.deepest = 0;
  for (const PairContact& contact : contacts_)
    counts_.deepest = std::max(counts_.deepest, static_cast<double>(overlap_of(contact, particles.displacements)));
}

void PairSystem::respond(const Record* positions, Record* velocities, float slow,
                         FunctionRef<Vec3f(int body)> gravity) const {
  for (const PairContact& contact : contacts_) {
    if (!(contact.push > 0)) continue;
    Vec3f missing{};
    for (int i = 0; i < 4; ++i)
      if (positions[contact.vertex[i]].w > 0) missing += gravity(model_.vertex_body[contact.vertex[i]]) * contact.weight[i];
    respond_to_contact(contact, positions, velocities, {missing, slow});
  }
  if (untangler_) untangler_->calm(model_.untangling_speed, velocities, gravity);
}

}  // namespace pliant
