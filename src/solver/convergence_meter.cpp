#include "solver/convergence_meter.h"

#include <algorithm>
#include <cmath>

#include "constraints/fibre.h"
#include "constraints/gives_shape.h"
#include "constraints/registry.h"
#include "constraints/triangle_shear.h"
#include "constraints/triangle_stretch.h"
#include "core/at.h"
#include "solver/damper.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// Measuring a constraint costs as much as this many of its projections in lanes, or of joints one at a time, over the
/// share of the frame that it may take.
constexpr double projections_in_lanes = 4000, projections_of_joints = 60;
/// An object is sampled in every so many frames, as what is read of it is no longer in the cache.
constexpr int frames_between = 4;
/// The fewest samples of a kind.
constexpr std::int64_t fewest_samples = 12;
/// Fractional part of the golden ratio: frames take other constraints, spread evenly.
constexpr double golden = 0.6180339887498949;
constexpr int joint_kind = static_cast<int>(Resistance::joints);

/// How much a sample counts of the one after it.
constexpr double kept_sums = 0.8;

int resistance_of(int type) {
  const std::string& name = constraint_type(type).name;
  const auto number = [](Resistance kind) { return static_cast<int>(kind); };
  if (is_hinge(type)) return number(Resistance::bending);
  if (name == TriangleStretch::name || name == Fibre::name) return number(Resistance::stretching);
  if (gives_shape(type) || name == TriangleShear::name) return number(Resistance::shear);
  if (belongs_to_solid(type)) return number(Resistance::volume);
  return constraint_type(type).is_joint ? number(Resistance::joints) : -1;
}

/// What is read of an object.
struct EstimatedObject {
  const CompiledObject& object;
  const Record *positions, *remainders, *velocities, *orientations, *inverse_inertias;
  const std::vector<AlignedVector<float>>& multipliers;
  const std::vector<std::vector<char>>& broken;  ///< ObjectJoints::is_broken
  double inverse_h2;

  /// The multipliers of a pool; null if it has none.
  const float* of_pool(int pool) const {
    return multipliers.empty() || multipliers[at(pool)].empty() ? nullptr : multipliers[at(pool)].data();
  }
};

EstimatedObject estimated_object(const MeasuredFrame& frame, int object) {
  const int first = frame.model.first[object], first_frame = frame.model.first_frame[object];
  const double h = static_cast<double>(frame.workspace.last_h[at(object)]);
  return {frame.model.objects[at(object)],
          frame.state.positions.data() + first,
          frame.state.remainders.data() + first,
          frame.state.velocities.data() + first,
          frame.state.frames.orientations.data() + first_frame,
          frame.state.frames.inverse_inertias.data() + first_frame,
          frame.workspace.multipliers[at(object)],
          frame.workspace.joints[at(object)].is_broken,
          1 / (h * h)};
}

/// Loads the slots; points are relative to the first one, with what their positions could not represent.
void load_estimated(const EstimatedObject& of, const Pool& pool, const std::int32_t* slots,
                    StencilArrays<float>& arrays) {
  const std::int32_t first = slots[0];
  for (int slot = 0; slot < pool.stencil; ++slot) {
    if (slots[slot] >= of.object.particles) {
      const Record& q = of.orientations[slots[slot] - of.object.particles];
      arrays.set_slot(slot, q.x, q.y, q.z, q.w);
      continue;
    }
    const Record &p = of.positions[slots[slot]], &r = of.remainders[slots[slot]];
    const Record &p0 = of.positions[first], &r0 = of.remainders[first];
    arrays.set_slot(slot, (p.x - p0.x) + (r.x - r0.x), (p.y - p0.y) + (r.y - r0.y), (p.z - p0.z) + (r.z - r0.z), 0);
  }
}

/// What the damping force explains of C: what damper.h leaves of alpha beta, times the rate of C.
double damping_explains(const EstimatedObject& of, const ConstraintPlace& at, const std::int32_t* slots,
                        const StencilArrays<float>& arrays) {
  if (at.pool.law != Law::damped) return 0;
  double rate = 0;
  for (int slot = 0; slot < at.pool.stencil; ++slot) {
    const Record& v = of.velocities[slots[slot]];
    rate += static_cast<double>(dot(arrays.gradient(at.pool, 0, slot), Vec3f{v.x, v.y, v.z}));
  }
  const double time = static_cast<double>(at.value(at.pool.fields)) * static_cast<double>(at.value(at.pool.fields + 1));
  return viscous_share(time, 1 / std::sqrt(of.inverse_h2)) * rate;
}

/// Adds an elastic constraint of one row over points.
void add_elastic_error(const EstimatedObject& of, const ConstraintPlace& at, const std::int32_t* slots,
                       ConvergenceSums& sums) {
  const double soft = softness(at, of.inverse_h2);
  if (!(soft > 0)) return;  // a rigid one among others of its type
  const double multiplier = static_cast<double>(of.of_pool(at.pool_number)[at.multiplier_place(0)]);
  const double elastic = soft * multiplier;
  StencilArrays<float> arrays;
  load_estimated(of, at.pool, slots, arrays);
  arrays.load_rest(at);
  constraint_type(at.pool.type).evaluate(arrays.slots, arrays.rest, arrays.c, arrays.gradients);
  const double c = static_cast<double>(arrays.c[0]) + damping_explains(of, at, slots, arrays);
  sums.work -= multiplier * (c + elastic);
  sums.elastic += multiplier * elastic;
  sums.deformed += c * c / std::max(soft, static_cast<double>(smallest_denominator));
  sums.force += std::fabs(multiplier);
  sums.squares += (c + elastic) * (c + elastic);
  sums.sampled += 1;
}

/// The radius of gyration of a body about the axis of which its inertia is greatest [m]; 0 of a fixed one.
double gyration_radius(const EstimatedObject& of, std::int32_t point, std::int32_t frame) {
  const Record& inverse = of.inverse_inertias[frame - of.object.particles];
  const float least = std::min({inverse.x, inverse.y, inverse.z});
  return least > 0 ? std::sqrt(static_cast<double>(of.positions[point].w / least)) : 0;
}

bool is_broken_joint(const EstimatedObject& of, const ConstraintPlace& place) {
  if (of.broken.empty() || of.broken[at(place.pool_number)].empty()) return false;
  return of.broken[at(place.pool_number)][at(batch_width * place.batch + place.lane)] != 0;
}

/// Adds the gap of a rigid joint over the size of its bodies. Rows that points change are lengths, others angles.
void add_gap(const EstimatedObject& of, const ConstraintPlace& at, const std::int32_t* slots, ConvergenceSums& sums) {
  if (softness(at, 1) > 0 || is_broken_joint(of, at)) return;
  StencilArrays<float> arrays;
  load_estimated(of, at.pool, slots, arrays);
  const Vec3f way{arrays.slots[8], arrays.slots[9], arrays.slots[10]};
  const double size = std::sqrt(static_cast<double>(dot(way, way))) + gyration_radius(of, slots[0], slots[1]) +
                      gyration_radius(of, slots[2], slots[3]);
  if (!(size > 0)) return;
  arrays.load_rest(at);
  constraint_type(at.pool.type).evaluate(arrays.slots, arrays.rest, arrays.c, arrays.gradients);
  for (int row = 0; row < at.pool.components; ++row) {
    const Vec3f by_point = arrays.gradient(at.pool, row, 0);
    const double c = static_cast<double>(arrays.c[row]), share = dot(by_point, by_point) > 0 ? c / size : c;
    sums.squares += share * share;
  }
  sums.sampled += 1;
}

/// Calls visit(place, slots) for every `stride`-th lane of a segment, and counts `next` down to the first of them.
template <class Visit>
void for_samples(const CompiledObject& object, const Segment& segment, std::int64_t stride, std::int64_t& next,
                 const Visit& visit) {
  const Pool& pool = object.pools[at(segment.pool)];
  const std::int64_t lanes = std::int64_t{segment.batches} * batch_width;
  for (; next < lanes; next += stride) {
    const int batch = static_cast<int>(next / batch_width), lane = static_cast<int>(next % batch_width);
    if (!lane_is_valid(segment, batch, lane)) continue;
    const std::int32_t* index =
        pool.indices.data() + segment.index_offset + std::ptrdiff_t{batch} * indices_per_batch(pool, segment);
    std::int32_t slots[most_slots];
    for (int slot = 0; slot < pool.stencil; ++slot) slots[slot] = particle_of(segment, index, slot, lane);
    visit(ConstraintPlace{pool, segment.pool, std::int64_t{segment.first_batch} + batch, lane}, slots);
  }
  next -= lanes;
}

/// Which lanes of a kind are sampled in a frame.
struct Sampling {
  std::int64_t lanes = 0, stride = 1, next = 0;

  void begin(std::int64_t frame, double projections) {
    const auto affordable = static_cast<std::int64_t>(static_cast<double>(lanes) * projections);
    stride = std::max<std::int64_t>(1, lanes / std::max(fewest_samples, affordable));
    const double turns = golden * static_cast<double>(frame);
    next = static_cast<std::int64_t>((turns - std::floor(turns)) * static_cast<double>(stride));
  }
};

}  // namespace

void ConvergenceSums::add(const ConvergenceSums& sample, double weight) {
  work = kept_sums * work + weight * sample.work;
  elastic = kept_sums * elastic + weight * sample.elastic;
  deformed = kept_sums * deformed + weight * sample.deformed;
  force = kept_sums * force + weight * sample.force;
  squares = kept_sums * squares + sample.squares;
  sampled = kept_sums * sampled + sample.sampled;
}

void ConvergenceMeter::list_kinds() {
  const int types = constraint_type_count();
  kinds_.reserve(static_cast<std::size_t>(types));
  for (int type = static_cast<int>(kinds_.size()); type < types; ++type)
    kinds_.push_back({resistance_of(type), gives_shape(type)});
}

void ConvergenceMeter::add(const EstimatedFrame& frame) {
  list_kinds();
  objects_.resize(frame.measured.model.objects.size());
  const auto first = static_cast<int>(frame.measured.state.frame % frames_between);
  for (int object = first; object < static_cast<int>(objects_.size()); object += frames_between) add(frame, object);
}

void ConvergenceMeter::list_pools(const EstimatedFrame& frame, int number) {
  const CompiledObject& object = frame.measured.model.objects[at(number)];
  const auto& multipliers = frame.measured.workspace.multipliers[at(number)];
  pools_.clear();
  for (std::size_t pool = 0; pool < object.pools.size(); ++pool) {
    const Pool& of = object.pools[pool];
    const int kind = of.law == Law::pbd ? -1 : kinds_[at(of.type)].kind;
    const bool is_known = kind == joint_kind || (!multipliers.empty() && !multipliers[pool].empty());
    pools_.push_back(is_known ? kind : -1);
    if (pools_.back() >= 0 && kinds_[at(of.type)].gives_shape) objects_[at(number)].is_solid = true;
  }
}

void ConvergenceMeter::add(const EstimatedFrame& frame, int number) {
  const CompiledObject& object = frame.measured.model.objects[at(number)];
  const auto h = static_cast<double>(frame.measured.workspace.last_h[at(number)]);
  if (object.is_collider || object.segments.empty() || !(h > 0)) return;
  ObjectSums& sums = objects_[at(number)];
  sums.substeps = static_cast<int>(std::lround(frame.dt / h));
  list_pools(frame, number);
  std::array<Sampling, resistance_count> sampling;
  for (std::size_t pool = 0; pool < pools_.size(); ++pool)
    if (pools_[pool] >= 0) sampling[at(pools_[pool])].lanes += std::int64_t{object.pools[pool].batches} * batch_width;
  const double passes = sums.substeps * frame.iterations;
  std::int64_t lanes = 0;
  for (int kind = 0; kind < static_cast<int>(resistance_count); ++kind) {
    sampling[at(kind)].begin(frame.measured.state.frame,
                             passes / (kind == joint_kind ? projections_of_joints : projections_in_lanes));
    lanes += sampling[at(kind)].lanes;
  }
  if (lanes == 0) return;
  const EstimatedObject of = estimated_object(frame.measured, number);
  std::array<ConvergenceSums, resistance_count> found;
  for (const Segment& segment : object.segments) {
    const int kind = pools_[at(segment.pool)];
    if (kind < 0) continue;
    for_samples(object, segment, sampling[at(kind)].stride, sampling[at(kind)].next,
                [&](const ConstraintPlace& place, const std::int32_t* slots) {
                  kind == joint_kind ? add_gap(of, place, slots, found[at(kind)])
                                     : add_elastic_error(of, place, slots, found[at(kind)]);
                });
  }
  for (std::size_t kind = 0; kind < resistance_count; ++kind)
    sums.of[kind].add(found[kind], static_cast<double>(sampling[kind].stride));
}

/// A solid yields in shear and volume together. One pass makes the directions of its shear forces differ from those of
/// its shear, so neither sum alone says how far it yields; the geometric mean of both does
/// (docs/internals/convergence.md).
ConvergenceEstimate ConvergenceMeter::estimate(const ObjectSums& sums, Resistance kind) {
  const ConvergenceSums& of = sums.of[static_cast<std::size_t>(kind)];
  const ConvergenceSums& volume = sums.of[static_cast<std::size_t>(Resistance::volume)];
  ConvergenceEstimate estimate;
  estimate.constraints = std::llround(of.sampled);
  estimate.substeps = sums.substeps;
  if (estimate.constraints == 0) return estimate;
  if (kind == Resistance::volume || kind == Resistance::joints) {
    estimate.excess = std::sqrt(of.squares / of.sampled);
    return estimate;
  }
  if (!(of.elastic > 0) || !(of.force > 0)) return estimate;
  estimate.excess = of.work / of.elastic;
  if (kind == Resistance::shear && sums.is_solid)
    estimate.excess = std::sqrt(of.deformed / of.elastic) - 1 + volume.work / (of.elastic + volume.elastic);
  estimate.strain = estimate.excess * of.elastic / of.force;
  if (kind == Resistance::stretching) estimate.excess = estimate.strain;
  return estimate;
}

ConvergenceEstimates ConvergenceMeter::estimates() const {
  ConvergenceEstimates all;
  for (std::size_t o = 0; o < objects_.size(); ++o)
    for (std::size_t k = 0; k < resistance_count; ++k) {
      const auto kind = static_cast<Resistance>(k);
      ConvergenceEstimate one = estimate(objects_[o], kind);
      if (one.constraints == 0 || (all[k].constraints > 0 && !is_farther(kind, one, all[k]))) continue;
      one.object = ObjectId(static_cast<int>(o), 0);
      all[k] = one;
    }
  return all;
}

bool is_farther(Resistance kind, const ConvergenceEstimate& first, const ConvergenceEstimate& second) {
  const bool is_told = !is_tolerable(kind, first), other_is_told = !is_tolerable(kind, second);
  return is_told != other_is_told ? is_told : first.excess > second.excess;
}

const char* name_of(Resistance kind) {
  constexpr std::array<const char*, resistance_count> names{"stretching", "bending", "shear",
                                                            "volume",     "joints",  "density"};
  return names[static_cast<std::size_t>(kind)];
}

bool is_tolerable(Resistance kind, const ConvergenceEstimate& estimate) {
  constexpr double of_bending = 0.25, of_angle = 0.001, of_shear = 0.1, of_strain = 0.002, of_small_shear = 0.15,
                   of_small_strain = 0.00002, of_volume = 0.05, of_others = 0.01;
  switch (kind) {
    case Resistance::stretching:
      return estimate.excess <= tolerated_p99;
    case Resistance::bending:
      return estimate.excess <= of_bending || estimate.strain <= of_angle;
    case Resistance::shear:
      return estimate.excess <= (estimate.strain > of_strain ? of_shear : of_small_shear) ||
             estimate.strain <= of_small_strain;
    case Resistance::volume:
      return estimate.excess <= of_volume;
    default:
      return estimate.excess <= of_others;
  }
}

}  // namespace pliant
