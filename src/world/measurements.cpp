// Measures a World between steps, and describes what falls short.
#include <algorithm>
#include <cmath>

#include "constraints/gives_shape.h"
#include "constraints/registry.h"
#include "constraints/tetrahedron_volume.h"
#include "constraints/volume_around_edge.h"
#include "math/matrix.h"
#include "matter/advice_settings.h"
#include "solver/substep_law.h"
#include "solver/visit.h"
#include "world/advice.h"
#include "world/groups.h"
#include "world/particles.h"
#include "world/resting_grains.h"

namespace pliant {

namespace {

/// Length of an object's substeps in the last step [s]; 1 if it took part in none, because then multipliers are zero.
float h_of(const WorldData& world, int number) {
  return world.workspace.last_h[number] > 0 ? world.workspace.last_h[number] : 1.f;
}

/// True if a figure is of an object's constraint that exists.
bool is_present(const Overstretch& found, const CompiledObject& object) {
  return std::all_of(found.particles.begin(), found.particles.end(),
                     [&](int particle) { return particle >= 0 && particle < object.particles; });
}

std::string of_unknown(const Overstretch& found) {
  return "an object that was removed or edited stretched " + percent(found.largest) + " too far";
}

/// The substeps that should keep an object of chains within the bounds; 0: unknown. Overstretch falls with the first to
/// second power of the substeps where a heavy body hits cloth or pins turn round (docs/internals/default_settings.md),
/// so with the square of the excess they suffice.
int substeps_to_hold(const Overstretch& found, const CompiledObject& object, int substeps) {
  constexpr double most = 500, multiple = 20, most_excess = 5;
  if (!solves_chains(object.sweep) || object.has_volume) return 0;
  const int by_state = object.surface.triangles.empty() ? most_of_ropes : most_by_state;
  const double excess = std::max(found.largest / tolerated_overstretch, found.p99 / tolerated_p99);
  const double wanted = (substeps > 0 ? substeps : by_state) * excess * excess;
  return excess <= most_excess ? static_cast<int>(multiple * std::ceil(std::min(wanted, most) / multiple)) : 0;
}

/// Six times the signed volume of a tetrahedron.
double six_volumes(const Record* positions, const std::int32_t* corners) {
  Vec3d x[4];
  for (int i = 0; i < 4; ++i) {
    const Record& p = positions[corners[i]];
    x[i] = {p.x, p.y, p.z};
  }
  return dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]);
}

/// The constraints that tell the tetrahedra of an object with their rest volumes.
struct TetrahedronType {
  int type = 0;
  double (*rest_volume)(const ConstraintPlace&) = nullptr;  ///< [m^3]
};

double given_rest_volume(const ConstraintPlace& at) { return static_cast<double>(at.value(0)); }

/// From D^-1, the inverse of three edges at rest.
double rest_volume_of_shape(const ConstraintPlace& at) {
  Matrix3d inverse;
  for (int i = 0; i < 9; ++i) inverse[i] = static_cast<double>(at.value(i));
  const double six = determinant(inverse);
  return six == 0 ? 0 : 1 / (6 * six);
}

/// The volume constraints, or those of shape if there are none of the former or they are joined around edges
/// (model/join_volumes.h).
std::vector<TetrahedronType> tetrahedron_types(const CompiledObject& object) {
  const int joined = find_constraint_type(VolumeAroundEdge::name),
            volume = find_constraint_type(TetrahedronVolume::name);
  const auto has = [&](int type) {
    return std::any_of(object.pools.begin(), object.pools.end(), [&](const Pool& pool) { return pool.type == type; });
  };
  if (!has(joined) && has(volume)) return {{volume, &given_rest_volume}};
  std::vector<TetrahedronType> types;
  for (int type = 0; type < constraint_type_count(); ++type)
    if (gives_shape(type) && has(type)) types.push_back({type, &rest_volume_of_shape});
  return types;
}

/// Sums of a TetrahedraMeasure while objects are added.
struct TetrahedraSum {
  TetrahedraMeasure measure;
  double volume = 0, at_rest = 0;  ///< [m^3]

  void add(const CompiledObject& object, ObjectId id, const Record* positions) {
    for (const TetrahedronType& of : tetrahedron_types(object)) add(object, of, id, positions);
  }

  void add(const CompiledObject& object, const TetrahedronType& of, ObjectId id, const Record* positions) {
    for_constraints(object, of.type, [&](const ConstraintPlace& at, const std::int32_t* corners) {
      const double rest = of.rest_volume(at);
      if (rest == 0) return;
      const double now = six_volumes(positions, corners) / 6, ratio = now / rest;
      ++measure.tetrahedra;
      measure.inverted += ratio < 0 ? 1 : 0;
      volume += std::copysign(now, ratio);
      at_rest += std::fabs(rest);
      const bool is_known =
          measure.particles[0] >= 0 && (ratio >= measure.least_ratio || std::isnan(measure.least_ratio));
      if (is_known) return;
      measure.least_ratio = ratio;
      measure.object = id;
      for (std::size_t i = 0; i < 4; ++i) measure.particles[i] = object.order[static_cast<std::size_t>(corners[i])];
    });
  }
};

}  // namespace

/// The overstretch with the slot of its object instead of the number in the model.
Overstretch with_slot(const WorldData& world, Overstretch measured) {
  if (measured.object < 0) return measured;
  const ObjectId id = world.ids.objects.id_of(measured.object);
  measured.object = id.slot;
  measured.generation = id.generation;
  return measured;
}

double Measurements::kinetic_energy() const {
  double energy = 0;
  for (std::size_t i = 0; i < world_->state.positions.size(); ++i) {
    const Record &v = world_->state.velocities[i], &x = world_->state.positions[i];
    if (x.w > 0) energy += 0.5 / x.w * (double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z);
  }
  const FrameRecords& frames = world_->state.frames;
  const auto turning = [](float speed, float inverse) { return inverse > 0 ? 0.5 / inverse * speed * speed : 0.0; };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Record &w = frames.angular_velocities[i], &inverse = frames.inverse_inertias[i];
    energy += turning(w.x, inverse.x) + turning(w.y, inverse.y) + turning(w.z, inverse.z);
  }
  return energy;
}

double Measurements::potential_energy() const {
  double energy = 0;
  const Vec3f& g = world_->model.gravity;
  const float* const rest_times = grain_rest_times(world_->state);
  for (std::size_t i = 0; i < world_->state.positions.size(); ++i) {
    const Record& x = world_->state.positions[i];
    const bool sleeps = rest_times != nullptr && rest_times[i] == asleep;
    const int particle = static_cast<int>(i);
    const float w = sleeps ? own_inverse_mass(world_->model, world_->model.object_of(particle), particle) : x.w;
    if (w > 0) energy -= 1.0 / w * (double(g.x) * x.x + double(g.y) * x.y + double(g.z) * x.z);
  }
  return energy;
}

std::vector<Residual> Measurements::residuals() const {
  return measure_residuals(world_->model, world_->state, world_->workspace,
                           [&](int object) { return h_of(*world_, object); });
}
Stretch Measurements::stretch() const {
  std::vector<float> ratios;
  return measure_stretch(world_->model, world_->state, ratios);
}
Overstretch Measurements::overstretch() const {
  OverstretchMeter meter;  // of its own and on this thread, because calls may be concurrent
  return with_slot(*world_,
                   meter.measure({world_->model, world_->state, world_->workspace, world_->kernels.lengths}, nullptr));
}

TetrahedraMeasure Measurements::tetrahedra() const {
  TetrahedraSum sum;
  for (std::size_t o = 0; o < world_->model.objects.size(); ++o)
    sum.add(world_->model.objects[o], world_->ids.objects.id_of(static_cast<int>(o)),
            world_->state.positions.data() + world_->model.first[o]);
  if (sum.at_rest > 0) sum.measure.volume_ratio = sum.volume / sum.at_rest;
  return sum.measure;
}

std::string Measurements::describe(const Overstretch& found) const {
  if (found.object < 0) return {};
  const ObjectId id(found.object, found.generation);
  if (!world_->ids.objects.has(id) || !is_present(found, world_->object(id))) return of_unknown(found);
  return words_of(found, world_->object(id));
}

std::string Measurements::advice(const Overstretch& found) const {
  if (is_tolerable(found)) return {};
  const ObjectId id(found.object, found.generation);
  if (!world_->ids.objects.has(id)) return of_unknown(found);
  const int substeps = substeps_of(*world_, world_->number(id));
  const int enough = substeps_to_hold(found, world_->object(id), substeps);
  const std::string more =
      (enough > 0 ? "\"substeps\": " + std::to_string(enough) + " should hold it, and " : std::string()) +
      (substeps > 0 ? "more than " + std::to_string(substeps) + " substeps"
                    : "a larger \"least_substeps\" or \"most_substeps\"");
  return describe(found) + "; " +
         (world_->open.departs.empty()
              ? more
              : "the default, with no " + world_->open.departs + " in the scene's \"settings\",") +
         " may reduce it: 'pliant check' or advise() finds out";
}

std::string Measurements::advice(const Report& report) const {
  return report.overstretch ? advice(*report.overstretch) : std::string();
}

}  // namespace pliant
