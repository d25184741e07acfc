#include "solver/fluids/viscosity.h"

#include <algorithm>
#include <cmath>

#include "core/at.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/body_solver.h"
#include "solver/fluids/fluid_solver.h"
#include "solver/fluids/for_groups.h"
#include "solver/substep.h"

namespace pliant {

namespace {

constexpr int most_iterations = 200;
/// A solve ends when the residual is this share of what it was, as root mean square over all masses, or so many
/// spacings.
constexpr double residual_share = 1e-4, least_residual = 1e-7;

}  // namespace

void FluidViscosity::clear() {
  of_point_.clear();
  has_any_ = false;
  are_alike_ = true;
}

void FluidViscosity::add(float viscosity, int particles) {
  if (particles == 0) return;
  are_alike_ = are_alike_ && (of_point_.empty() || of_point_.front() == viscosity);
  has_any_ = has_any_ || viscosity > 0;
  of_point_.resize(of_point_.size() + at(particles), viscosity);
}

ViscosityArrays FluidViscosity::arrays(const Substep& s, const FluidPool& pool) {
  ViscosityArrays a{viscosity_law(pool.law.reach / 2)};
  a.scale = a.law.scale * s.h * (are_alike_ ? of_point_.front() : 1);
  a.places = pool.places.data();
  a.viscosities = are_alike_ ? nullptr : viscosities_.data();
  a.forces = forces_.data();
  return a;
}

void FluidViscosity::gather(Substep& s, const FluidPool& pool, bool is_first) {
  const std::size_t padded = pool.places.size();
  for (auto* of : {&viscosities_, &masses_, &inverse_masses_}) of->assign(padded, 0);
  motions_.assign(padded, {});
  directions_.assign(padded, {});
  forces_.resize(padded);
  residuals_.resize(padded);
  if (is_first) impulses_.assign(padded, {});
  parts_.resize(at(pool.neighbours.groups()));
  const std::vector<std::int32_t>& points = pool.neighbours.order().points();
  for_groups(s.context.executor, "solve: viscosity", pool.neighbours, [&](int, int first, int last) {
    for (std::size_t slot = at(first); slot < at(last); ++slot) {
      const std::size_t particle = at(pool.of_slot[slot]);
      const float inverse = s.state.positions[particle].w;
      inverse_masses_[slot] = inverse;
      masses_[slot] = inverse > 0 ? 1 / inverse : 0;
      viscosities_[slot] = of_point_[at(points[slot])];
      motions_[slot] = s.work.displacements[particle];
    }
  });
  before_ = motions_;
  gather_bodies(s, is_first);
}

void FluidViscosity::gather_bodies(Substep& s, bool is_first) {
  const bool has_bodies = s.bodies != nullptr && !s.bodies->solids().empty();
  const std::size_t count = has_bodies ? s.bodies->touched_bodies().size() : 0;
  if (is_first) bodies_.assign(count, {});
  bodies_before_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const TouchedBody& of = s.bodies->touched_bodies()[i];
    Body& body = bodies_[i];
    body = {{}, body.impulse, {}, {}, {}, {}, false};
    body.motion.linear = xyz(s.work.displacements[at(of.particle)]);
    body.motion.angular = turn_between(quaternion(s.work.frames.starts[at(of.frame)]),
                                       quaternion(s.state.frames.orientations[at(of.frame)]));
    bodies_before_[i] = body.motion;
  }
}

/// The motion of a particle along a wall, against it.
Vec3f FluidViscosity::slip(const WallGrip& grip, const Record& motion, bool with_walls) const {
  Vec3f way = xyz(motion);
  if (grip.body < 0) return grip.along(with_walls ? way - grip.motion : way);
  const Body& body = bodies_[at(grip.body)];
  const Twist& of = with_walls ? body.motion : body.way;
  return grip.along(way - of.linear - cross(of.angular, grip.arm));
}

/// Forces against the motions of particles: displacements, if walls move too, or a search direction.
void FluidViscosity::resist(Substep& s, const FluidPool& pool, const Records& motions, bool with_walls) {
  ViscosityArrays a = arrays(s, pool);
  a.motions = motions.data();
  for_groups(s.context.executor, "solve: viscosity", pool.neighbours, [&](int group, int, int) {
    s.kernels.viscosity.resist(a, pool.neighbours.group(group), group);
    for (const WallGrip& grip : walls_.of_group(group)) {
      Record& force = forces_[at(grip.slot)];
      force = plus(force, slip(grip, motions[at(grip.slot)], with_walls) * grip.factor);
    }
  });
  resist_bodies(motions, with_walls);
}

void FluidViscosity::resist_bodies(const Records& motions, bool with_walls) {
  if (bodies_.empty()) return;
  for (Body& body : bodies_) body.force = {};
  for (const WallGrip& grip : walls_.all()) {
    if (grip.body < 0) continue;
    const Vec3f force = slip(grip, motions[at(grip.slot)], with_walls) * -grip.factor;
    Twist& sum = bodies_[at(grip.body)].force;
    sum.linear += force;
    sum.angular += cross(grip.arm, force);
  }
}

/// The residual of u + M^-1 h L u = u0, where u0 is what the displacements would be without viscosity.
void FluidViscosity::start(Substep& s, const FluidPool& pool) {
  resist(s, pool, motions_, true);
  for_groups(s.context.executor, "solve: viscosity", pool.neighbours, [&](int, int first, int last) {
    for (std::size_t slot = at(first); slot < at(last); ++slot) {
      const Vec3f lack = xyz(impulses_[slot]) + xyz(forces_[slot]) * inverse_masses_[slot];
      residuals_[slot] = inverse_masses_[slot] > 0 ? plus(Record{}, -lack) : Record{};
    }
  });
  for (Body& body : bodies_) {
    if (!body.is_held) continue;
    body.residual = {-(body.impulse.linear + body.force.linear), -(body.impulse.angular + body.force.angular)};
  }
}

double FluidViscosity::sum(double of_bodies) const {
  double all = of_bodies;
  for (const double part : parts_) all += part;
  return all;
}

double FluidViscosity::squared_residual(Substep& s, const FluidPool& pool) {
  for_groups(s.context.executor, "solve: viscosity", pool.neighbours, [&](int group, int first, int last) {
    double part = 0;
    for (std::size_t slot = at(first); slot < at(last); ++slot)
      part += static_cast<double>(masses_[slot]) *
              dot(convert<double>(xyz(residuals_[slot])), convert<double>(xyz(residuals_[slot])));
    parts_[at(group)] = part;
  });
  double of_bodies = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].is_held) continue;
    const BodyMotion& motion = s.bodies->present_motions()[i];
    const Twist& r = bodies_[i].residual;
    of_bodies += static_cast<double>(motion.inverse_mass) * dot(convert<double>(r.linear), convert<double>(r.linear)) +
                 dot(convert<double>(r.angular), convert<double>(times(motion.inverse_inertia, r.angular)));
  }
  return sum(of_bodies);
}

/// direction = residual + share times direction.
void FluidViscosity::turn_direction(Substep& s, const FluidPool& pool, float share) {
  for_groups(s.context.executor, "solve: viscosity", pool.neighbours, [&](int, int first, int last) {
    for (std::size_t slot = at(first); slot < at(last); ++slot)
      directions_[slot] = plus(residuals_[slot], xyz(directions_[slot]) * share);
  });
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    if (!body.is_held) continue;
    const BodyMotion& motion = s.bodies->present_motions()[i];
    const auto turned = [&](const Vec3f& to, const Vec3f& from) { return to + from * share; };
    body.way.linear = turned(body.residual.linear * motion.inverse_mass, body.way.linear);
    body.way.angular = turned(times(motion.inverse_inertia, body.residual.angular), body.way.angular);
    body.direction = {turned(body.residual.linear, body.direction.linear),
                      turned(body.residual.angular, body.direction.angular)};
  }
}

/// The product of the direction with what the operator makes of it.
double FluidViscosity::work_along(Substep& s, const FluidPool& pool) {
  resist(s, pool, directions_, false);
  for_groups(s.context.executor, "solve: viscosity", pool.neighbours, [&](int group, int first, int last) {
    double part = 0;
    for (std::size_t slot = at(first); slot < at(last); ++slot) {
      const Vec3d way = convert<double>(xyz(directions_[slot]));
      part += dot(way, way * static_cast<double>(masses_[slot]) + convert<double>(xyz(forces_[slot])));
    }
    parts_[at(group)] = part;
  });
  double of_bodies = 0;
  for (const Body& body : bodies_)
    of_bodies += dot(convert<double>(body.way.linear), convert<double>(body.direction.linear + body.force.linear)) +
                 dot(convert<double>(body.way.angular), convert<double>(body.direction.angular + body.force.angular));
  return sum(of_bodies);
}

/// Goes a step along the direction. Returns the squared residual.
double FluidViscosity::update(Substep& s, const FluidPool& pool, float step) {
  for_groups(s.context.executor, "solve: viscosity", pool.neighbours, [&](int, int first, int last) {
    for (std::size_t slot = at(first); slot < at(last); ++slot) {
      if (!(inverse_masses_[slot] > 0)) continue;
      const Vec3f way = xyz(directions_[slot]);
      motions_[slot] = plus(motions_[slot], way * step);
      residuals_[slot] = plus(residuals_[slot], (way + xyz(forces_[slot]) * inverse_masses_[slot]) * -step);
    }
  });
  for (Body& body : bodies_) {
    if (!body.is_held) continue;
    body.motion = {body.motion.linear + body.way.linear * step, body.motion.angular + body.way.angular * step};
    body.impulse = {body.impulse.linear + body.direction.linear * step,
                    body.impulse.angular + body.direction.angular * step};
    body.residual = {body.residual.linear - (body.direction.linear + body.force.linear) * step,
                     body.residual.angular - (body.direction.angular + body.force.angular) * step};
  }
  return squared_residual(s, pool);
}

void FluidViscosity::scatter(Substep& s, const FluidPool& pool) {
  for_groups(s.context.executor, "solve: viscosity", pool.neighbours, [&](int, int first, int last) {
    for (std::size_t slot = at(first); slot < at(last); ++slot) {
      const Vec3f change = xyz(motions_[slot]) - xyz(before_[slot]);
      impulses_[slot] = plus(impulses_[slot], change);
      Record& d = s.work.displacements[at(pool.of_slot[slot])];
      d = plus(d, change);
    }
  });
  scatter_bodies(s);
}

void FluidViscosity::scatter_bodies(Substep& s) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].is_held) continue;
    const TouchedBody& of = s.bodies->touched_bodies()[i];
    Record& d = s.work.displacements[at(of.particle)];
    d = plus(d, bodies_[i].motion.linear - bodies_before_[i].linear);
    const Vec3f turned = bodies_[i].motion.angular - bodies_before_[i].angular;
    if (turned == Vec3f{}) continue;
    Record& corrections = s.work.frames.corrections[at(of.frame)];
    corrections = plus(corrections, turned);
    rotate_by(turned, s.state.frames.orientations[at(of.frame)]);
  }
}

void FluidViscosity::solve(Substep& s, FluidPool& pool, bool is_first) {
  if (!has_any_) return;
  gather(s, pool, is_first);
  const FluidBounds bounds = FluidBodies::bounds(s, pool.objects.front());
  ViscosityArrays a = arrays(s, pool);
  walls_.find(s, a.law, pool.walls, bounds, pool.places, viscosities_, pool.neighbours.slots());
  for (const WallGrip& grip : walls_.all())
    if (grip.body >= 0) bodies_[at(grip.body)].is_held = true;
  for_groups(s.context.executor, "solve: viscosity", pool.neighbours,
             [&](int group, int, int) { s.kernels.viscosity.find_factors(a, pool.neighbours.group(group), group); });
  start(s, pool);
  double mass = 0;
  for (const float of : masses_) mass += static_cast<double>(of);
  const double least = least_residual * static_cast<double>(pool.law.reach) / 2;
  double squared = squared_residual(s, pool);
  const double first = squared, wanted = std::max(squared * residual_share * residual_share, mass * least * least);
  int made = 0;
  for (float share = 0; squared > wanted && made < most_iterations; ++made) {
    turn_direction(s, pool, share);
    const double work = work_along(s, pool);
    if (!(work > 0)) break;
    const double next = update(s, pool, static_cast<float>(squared / work));
    share = static_cast<float>(next / squared);
    squared = next;
  }
  solves_.iterations = std::max(solves_.iterations, made);
  if (squared > wanted) {
    ++solves_.unfinished;
    solves_.residual = std::max(solves_.residual, std::sqrt(squared / first));
  }
  scatter(s, pool);
}

}  // namespace pliant
