#include "collision/surfaces/surface_contact.h"

#include <algorithm>

namespace pliant {

namespace {

/// Share of the thickness that contacts must keep while a kinematic collider moves by up to half a thickness in a
/// substep.
constexpr float least_share_kept = 0.9f;

/// True if a kinematic side of a contact moves by more than the loss of thickness that least_share_kept permits.
bool is_driven(const Contact& contact, const PairParticles& particles) {
  float way = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Record& d = particles.displacements[contact.point[i]];
    if (!(particles.positions[contact.point[i]].w > 0))
      way += contact.weight[i] * dot(contact.normal, Vec3f{d.x, d.y, d.z});
  }
  return -way > (1 - least_share_kept) * contact.thickness;
}

/// Which dynamic bodies contacts connect, directly or through others.
class ConnectedBodies {
 public:
  ConnectedBodies(const PairModel& model, const PairParticles& particles, const std::vector<Contact>& contacts)
      : model_(model), positions_(particles.positions) {
    for (int body = 0; body < model.shared->rules.bodies(); ++body) parent_.push_back(body);
    for (const Contact& contact : contacts) {
      const int first = of(contact);
      for (std::size_t i = 0; i < 4; ++i)
        if (is_dynamic(contact, i)) parent_[root(model.shared->vertex_body[contact.point[i]])] = root(first);
    }
  }

  std::size_t count() const { return parent_.size(); }
  int root(int body) const {
    while (parent_[body] != body) body = parent_[body];
    return body;
  }
  /// The root of a contact's dynamic bodies; -1 if it has none.
  int of(const Contact& contact) const {
    for (std::size_t i = 0; i < 4; ++i)
      if (is_dynamic(contact, i)) return root(model_.shared->vertex_body[contact.point[i]]);
    return -1;
  }

 private:
  bool is_dynamic(const Contact& contact, std::size_t i) const {
    return contact.weight[i] != 0 && positions_[contact.point[i]].w > 0;
  }

  const PairModel& model_;
  const Record* positions_;
  std::vector<int> parent_;
};

}  // namespace

SurfaceContact::SurfaceContact(const PairModel& model, const PairKernels& kernels)
    : model_(model), lists_(model, kernels), detector_(model), points_(model), filter_(model), intersections_(model) {
  if (model.untangling_speed > 0) untangler_ = std::make_unique<Untangler>(model);
}

void SurfaceContact::change(const PairChanges& changes) {
  contacts_.clear();
  static_contacts_ = 0;
  lists_.change(changes);
  filter_.fit_to_model();
  intersections_.change(changes.removed, changes.added);
}

PairCounts SurfaceContact::counts() const {
  PairCounts counts;
  counts.candidates = lists_.candidates();
  counts.contacts = pushing_;
  counts.truncated = filter_.truncated();
  counts.unresolvable = filter_.unresolvable_count();
  counts.intersecting = static_cast<std::int64_t>(intersections_.found().size());
  counts.rebuilds = lists_.rebuilds() - rebuilds_before_;
  counts.inside = untangler_ ? untangler_->inside() : 0;
  counts.deepest = deepest_;
  return counts;
}

void SurfaceContact::begin_frame(const Record* positions, bool rebuild) {
  // Pairs that the filter kept from crossing need no new search. Without the filter, crossed pairs become exempt.
  const bool kept_apart = model_.filter && filter_.unresolvable_count() == 0;
  const bool untangles = untangler_ && untangler_->is_busy();
  filter_.forget_counts();
  pushing_ = 0;
  deepest_ = 0;
  rebuilds_before_ = lists_.rebuilds();
  if (!rebuild && intersections_.found().empty() && kept_apart && !untangles) {
    intersections_.find_of_new(positions);
    return;
  }
  intersections_.find(positions, rebuild);
  if (untangler_) untangler_->begin_frame(positions, intersections_.found());
  if (rebuild) lists_.forget();
}

std::vector<int> SurfaceContact::too_far() const {
  std::vector<int> bodies;
  for (int c = 0; c < model_.clusters; ++c)
    if (is_too_far(lists_.neighbourhood(), c)) bodies.push_back(model_.cluster_body[c]);
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

// ---------------------------------------------------------------- contacts

void SurfaceContact::detect(Executor& executor, const PairParticles& particles) {
  contacts_.clear();
  static_contacts_ = 0;
  births_ = particles.births;
  if (untangler_)
    untangler_->push(model_.untangling_speed * particles.h, particles.h, particles.displacements, particles.remainders);
  is_bounded_ = lists_.measure(executor, particles);
  if (!is_bounded_) return;  // the end of the substep reports the position
  lists_.update(executor, particles);
  static_contacts_ = detector_.detect(
      executor, lists_.neighbourhood(), particles, [&](const PairStencil& pair) { return is_exempt(pair); }, contacts_);
  points_.detect(executor, particles, contacts_);
}

/// Contacts of other bodies count too: a vertex whose step the filter truncates for one of them cannot move out of the
/// way. So bodies that contacts connect are judged together, as they are if the model has no others.
bool SurfaceContact::find_overrun(const PairParticles& particles, std::vector<char>& is_overrun) const {
  const auto lacks = [&](const Contact& contact) {
    return overlap_of(contact, particles.displacements) > (1 - least_share_kept) * contact.thickness;
  };
  const auto is_driven_here = [&](const Contact& contact) { return is_driven(contact, particles); };
  if (std::none_of(contacts_.begin(), contacts_.end(), is_driven_here) ||
      std::none_of(contacts_.begin(), contacts_.end(), lacks))
    return false;
  ConnectedBodies connected(model_, particles, contacts_);
  std::vector<char> driven(connected.count(), 0), lacking(connected.count(), 0);
  for (const Contact& contact : contacts_) {
    const int body = connected.of(contact);
    if (body < 0) continue;
    if (is_driven_here(contact)) driven[body] = 1;
    if (lacks(contact)) lacking[body] = 1;
  }
  is_overrun.assign(connected.count(), 0);
  for (int body = 0; body < static_cast<int>(is_overrun.size()); ++body)
    is_overrun[body] = static_cast<char>(driven[connected.root(body)] & lacking[connected.root(body)]);
  return std::any_of(is_overrun.begin(), is_overrun.end(), [](char is) { return is != 0; });
}

void SurfaceContact::measure_overlaps(const PairParticles& particles) {
  deepest_ = 0;
  for (const Contact& contact : contacts_)
    deepest_ = std::max(deepest_, static_cast<double>(overlap_of(contact, particles.displacements)));
}

/// Gravity of this frame that the relative velocity at a contact does not include yet [m/s].
Vec3f SurfaceContact::missing_of(const Contact& contact, const Record* positions,
                                 FunctionRef<Vec3f(int body)> gravity) const {
  Vec3f missing{};
  for (int i = 0; i < 4; ++i)
    if (positions[contact.point[i]].w > 0)
      missing += gravity(model_.shared->vertex_body[contact.point[i]]) * contact.weight[i];
  return missing;
}

float SurfaceContact::end_impact(const Contact& contact, const Record* positions, Record* velocities,
                                 FunctionRef<Vec3f(int body)> gravity) const {
  return pliant::end_impact(contact, velocities, missing_of(contact, positions, gravity));
}

void SurfaceContact::respond(const Contact& contact, const Record* positions, Record* velocities, float slow,
                             FunctionRef<Vec3f(int body)> gravity) const {
  if (contact.push > 0) respond_to_contact(contact, velocities, {missing_of(contact, positions, gravity), slow});
}

void SurfaceContact::limit_untangling(Record* velocities, FunctionRef<Vec3f(int body)> gravity) const {
  if (untangler_) untangler_->limit_speeds(model_.untangling_speed, velocities, gravity);
}

// ---------------------------------------------------------------- filter

void SurfaceContact::filter(Executor& executor, const PairParticles& particles,
                            FunctionRef<const FreeBodies&()> find_free) {
  pushing_ = 0;
  has_impacts_ = false;
  births_ = particles.births;
  for (const Contact& contact : contacts_) {
    pushing_ += contact.push > 0 ? 1 : 0;
    has_impacts_ = has_impacts_ || is_impact(contact);
  }
  const auto exempt = [&](const PairStencil& pair) { return is_exempt(pair); };
  is_bounded_ = model_.filter ? filter_.apply(executor, lists_, particles, find_free, exempt)
                              : lists_.measure(executor, particles);
}

bool SurfaceContact::comes_near(int body, const BoxBounds& box, float reach) const {
  const BoxBounds grown = box.grown(reach);
  const Block clusters = model_.bodies.at(body).clusters;
  for (int c = clusters.first; c < clusters.end(); ++c) {
    const ClusterMotion& motion = lists_.neighbourhood().motions[c];
    if (overlap(grown, {min(motion.low[0], motion.low[1]), max(motion.high[0], motion.high[1])})) return true;
  }
  return false;
}

/// What counts the motion of clusters must know it as it is in the end.
void SurfaceContact::end_substep(Executor& executor, const PairParticles& particles, bool has_moved) {
  if (has_moved && is_bounded_) is_bounded_ = lists_.measure(executor, particles);
  if (is_bounded_) lists_.advance();
}

}  // namespace pliant
