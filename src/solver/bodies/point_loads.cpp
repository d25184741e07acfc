#include "solver/bodies/point_loads.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "constraints/registry.h"
#include "solver/bodies/body_math.h"
#include "solver/momentum.h"
#include "solver/substep.h"
#include "solver/sweeps/sweep.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// A point of an edge or triangle with a smaller weight in the contact hardly feels the body.
constexpr float least_weight = 0.3f;

/// A body that presses on a particle by less than this many of its weights is moved well enough by contacts alone.
constexpr float least_weights = 20;

/// A body under cloth bears it, instead of being borne, if the normal of contact is within 60 degrees of upward.
constexpr float upward = 0.5f;

/// True if a contact presses so much that its points should carry the body.
bool is_heavy(const Substep& s, const Contact& c, float impulse) {
  const bool bears = dot(c.normal, s.model.gravity) < -upward * length(s.model.gravity);
  return c.push > 0 && !bears &&
         impulse * inverse_mass_of(c, s.state.positions.data()) > least_weights * length(s.model.gravity) * s.h;
}

/// Inverse mass of a body at an arm for an impulse along a direction [1/kg].
float mobility(const BodyMotion& body, const Vec3f& arm, const Vec3f& direction) {
  const Vec3f turning = cross(arm, direction);
  return body.inverse_mass + dot(turning, times(body.inverse_inertia, turning));
}

/// The mean of the mobilities across an axis along which the body only translates.
float mobility_across(const BodyMotion& body, const Vec3f& arm) {
  const std::array<float, 6>& m = body.inverse_inertia;
  return body.inverse_mass + 0.5f * (length_squared(arm) * (m[0] + m[1] + m[2]) - dot(arm, times(m, arm)));
}

/// A body's inertia for each of `carriers` particles. All together they may not exceed its mass; where they turn it, a
/// particle moves it more easily than by its mass, and others share in the turn.
float share_of(float inverse_mass, float mobility, int carriers) {
  const auto n = static_cast<float>(carriers);
  return min(1 / (inverse_mass * n), 1 / (mobility * max(1.f, 0.5f * n)));
}

/// The ties of an object that yield: particles and frames, by their numbers in the object. In the chain's system a body
/// hangs rigidly on its particle, which would take the compliance out of such a tie.
std::vector<std::pair<int, int>> yielding_ties(const CompiledObject& object) {
  std::vector<std::pair<int, int>> found;
  for (int type = 0; type < constraint_type_count(); ++type) {
    if (!constraint_type(type).is_tie) continue;
    for_constraints(object, type, [&](const ConstraintPlace& at, const std::int32_t* slots) {
      if (at.pool.law == Law::pbd || softness(at, 1) > 0) found.emplace_back(slots[2], slots[1] - object.particles);
    });
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

PointLoads::PointLoads(const Model& model, const std::vector<TouchedBody>& bodies) : bodies_(bodies) {
  std::vector<std::pair<int, int>> yielding;
  int last = -1;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const int number = bodies_[b].object;
    const CompiledObject& object = model.objects[at(number)];
    if (!solves_chains(object.sweep) || object.bodies.attached.empty()) continue;
    if (number != last) yielding = yielding_ties(object);
    last = number;
    const int frame = object.bodies.bodies[at(bodies_[b].body)].frame;
    for (const auto& [point, body] : object.bodies.attached)
      if (body == bodies_[b].body && !std::binary_search(yielding.begin(), yielding.end(), std::pair{point, frame}))
        ties_.emplace_back(point + model.first[at(number)], static_cast<int>(b));
  }
  std::sort(ties_.begin(), ties_.end());
  find_paths(model);
}

void PointLoads::find_paths(const Model& model) {
  std::vector<std::pair<int, Lane>> all;  // by particle in the State
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    first_batch_.push_back(lanes_.size());
    for (const ChainBatch& batch : object.chains) {
      const auto number = static_cast<std::int32_t>(lanes_.size());
      for (int k = 0; k < batch.steps; ++k) {
        const Segment& link = object.segments[at(batch.first_segment + k)];
        const std::int32_t* const points = object.pools[at(batch.pool)].indices.data() + link.index_offset;
        for (int lane = 0; lane < link.last_count; ++lane)
          for (const int slot : {0, batch_width})
            all.push_back({points[slot + lane] + model.first[o], {number, 1u << lane}});
      }
      lanes_.push_back(0);
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [particle, lane] : all) {
    while (static_cast<int>(first_path_.size()) <= particle) first_path_.push_back(static_cast<int>(paths_.size()));
    paths_.push_back(lane);
  }
  first_path_.push_back(static_cast<int>(paths_.size()));
}

/// Sets or clears the lanes of all loads.
void PointLoads::mark_lanes(bool are_loaded) {
  for (const Load& load : loads_) {
    if (at(load.particle) + 1 >= first_path_.size()) continue;
    for (int i = first_path_[at(load.particle)]; i < first_path_[at(load.particle) + 1]; ++i) {
      std::uint32_t& lanes = lanes_[at(paths_[at(i)].batch)];
      lanes = are_loaded ? lanes | paths_[at(i)].bit : 0;
    }
  }
}

void PointLoads::note_pressed(const Substep& s, const Contacts& contacts) {
  for (const int particle : pressed_) pressed_by_[at(particle)] = 0;
  pressed_.clear();
  for (std::size_t n = 0; n < contacts.all.size(); ++n) {
    const Contact& c = contacts.all[n];
    if (!is_heavy(s, c, contacts.impulses[n])) continue;
    for (std::size_t i = 0; i < c.point.size(); ++i) {
      if (!(c.weight[i] > least_weight)) continue;
      if (pressed_by_.size() <= at(c.point[i])) pressed_by_.resize(at(c.point[i]) + 1);
      pressed_by_[at(c.point[i])] = 1 + contacts.body_of_solid[at(c.collider)];
      pressed_.push_back(c.point[i]);
    }
  }
}

void PointLoads::add(int particle, int body, int contact, const Vec3f& axis) {
  const std::int32_t known = of_particle_[at(particle)];
  if (known >= 0) {
    Load& load = loads_[at(known)];
    if (load.contact >= 0 && load.body == body) load.axis += axis;
    return;
  }
  of_particle_[at(particle)] = static_cast<std::int32_t>(loads_.size());
  loads_.push_back({particle, body, contact, axis});
}

void PointLoads::add_ties(const Substep& s) {
  for (const auto& [particle, body] : ties_) {
    const Vec3f arm = (xyz(s.state.positions[at(particle)]) + xyz(s.work.displacements[at(particle)])) -
                      (xyz(s.state.positions[at(bodies_[at(body)].particle)]) +
                       xyz(s.work.displacements[at(bodies_[at(body)].particle)]));
    add(particle, body, -1, arm);
  }
}

void PointLoads::add_contacts(const Substep& s, const Contacts& contacts, bool begins) {
  const Model& model = s.model;
  for (std::size_t n = 0; n < contacts.all.size(); ++n) {
    const Contact& c = contacts.all[n];
    if (!begins && !is_heavy(s, c, contacts.impulses[n])) continue;
    const int body = contacts.body_of_solid[at(c.collider)];
    for (std::size_t i = 0; i < c.point.size(); ++i) {
      if (!(c.weight[i] > least_weight)) continue;
      const std::size_t particle = at(c.point[i]);
      if (begins && (particle >= pressed_by_.size() || pressed_by_[particle] != 1 + body)) continue;
      if (solves_chains(model.objects[at(model.object_of(c.point[i]))].sweep))
        add(c.point[i], body, static_cast<int>(n), c.normal * c.weight[i]);
    }
  }
}

void PointLoads::share_inertia(const Substep& s, const std::vector<BodyMotion>& motions) {
  carriers_.assign(bodies_.size(), 0);
  for (const Load& load : loads_) ++carriers_[at(load.body)];
  inertias_.clear();
  for (Load& load : loads_) {
    const TouchedBody& body = bodies_[at(load.body)];
    const BodyMotion& motion = motions[at(load.body)];
    const Record& x = s.state.positions[at(load.particle)];
    const Vec3f arm = (xyz(x) + xyz(s.work.displacements[at(load.particle)])) -
                      (xyz(s.state.positions[at(body.particle)]) + xyz(s.work.displacements[at(body.particle)]));
    const float size = length(load.axis);
    load.axis = size > 0 ? load.axis * (1 / size) : Vec3f{0, 1, 0};
    LoadedInertia inertia{load.axis, 0, load.contact < 0 ? 0 : std::sqrt(x.w)};
    if (motion.inverse_mass > 0 && x.w > 0) {
      const int carriers = carriers_[at(load.body)];
      load.along = share_of(motion.inverse_mass, mobility(motion, arm, load.axis), carriers);
      inertia.root_along = 1 / std::sqrt(1 / x.w + load.along);
      if (load.contact < 0) {
        load.across = share_of(motion.inverse_mass, mobility_across(motion, arm), carriers);
        inertia.root_across = 1 / std::sqrt(1 / x.w + load.across);
      }
    }
    inertias_.push_back(inertia);
  }
}

void PointLoads::find(const Substep& s, const Contacts& contacts, const std::vector<BodyMotion>& motions, bool begins) {
  is_loaded_.assign(s.model.objects.size(), 0);
  if (of_particle_.size() != s.state.positions.size()) of_particle_.assign(s.state.positions.size(), -1);
  for (const Load& load : loads_) of_particle_[at(load.particle)] = -1;
  mark_lanes(false);
  kept_.swap(loads_);
  loads_.clear();
  add_ties(s);
  add_contacts(s, contacts, begins);
  share_inertia(s, motions);
  mark_lanes(true);
  for (const Load& load : loads_) is_loaded_[at(s.model.object_of(load.particle))] = 1;
  if (begins) return;
  for (const Load& old : kept_) {
    const std::int32_t now = of_particle_[at(old.particle)];
    if (now >= 0 && loads_[at(now)].body == old.body) loads_[at(now)].given = old.given;
  }
}

void PointLoads::begin_chains(const Substep& s) {
  is_released_.assign(loads_.size(), 0);
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    Load& load = loads_[i];
    load.before = xyz(s.work.displacements[at(load.particle)]);
    inertias_[i].farthest = load.contact < 0 ? std::numeric_limits<float>::infinity()
                            : load.along > 0 ? load.given / load.along
                                             : 0;
  }
}

Vec3f PointLoads::impulse_of(Load& load, const Vec3f& moved) const {
  const float along = dot(load.axis, moved);
  if (load.contact < 0) return load.axis * (along * load.along) + (moved - load.axis * along) * load.across;
  const float push = -along * load.along;
  load.given = max(load.given + push, 0.f);
  return load.axis * -push;
}

namespace {

/// Lets the particle's object keep the momentum that its chains have given to a body. `apart` is the displacement of
/// the particle less that of the body: so, with the arm of the present, the angular momentum about any point adds up.
void note_impulse(Substep& s, int particle, const Vec3f& apart, const Vec3f& impulse) {
  const int object = s.model.object_of(particle);
  const auto& x = s.state.positions;
  const Vec3f from_first = xyz(x[at(particle)]) - xyz(x[at(s.model.first[at(object)])]);
  note_impulse_on_body(s, object, from_first + apart, impulse);
}

}  // namespace

void PointLoads::end_chains(Substep& s, const std::vector<BodyMotion>& motions, std::vector<float>& impulses) {
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    Load& load = loads_[i];
    const BodyMotion& motion = motions[at(load.body)];
    if (is_released_[i] != 0 || !(motion.inverse_mass > 0)) continue;
    const Record& d = s.work.displacements[at(load.particle)];
    const Vec3f impulse = impulse_of(load, xyz(d) - load.before);
    if (impulse == Vec3f{}) continue;
    if (load.contact >= 0) impulses[at(load.contact)] -= dot(load.axis, impulse) / s.h;
    const TouchedBody& body = bodies_[at(load.body)];
    Record& of_body = s.work.displacements[at(body.particle)];
    const Vec3f arm = (xyz(s.state.positions[at(load.particle)]) + xyz(d)) -
                      (xyz(s.state.positions[at(body.particle)]) + xyz(of_body));
    note_impulse(s, load.particle, xyz(d) - xyz(of_body), impulse);
    of_body = plus(of_body, impulse * motion.inverse_mass);
    const Vec3f turned = times(motion.inverse_inertia, cross(arm, impulse));
    Record& corrections = s.work.frames.corrections[at(body.frame)];
    corrections = plus(corrections, turned);
    rotate_by(turned, s.state.frames.orientations[at(body.frame)]);
  }
}

}  // namespace pliant
