#include "solver/sweeps/record.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "constraints/all.h"
#include "solver/frame.h"
#include "solver/project.h"
#include "solver/volume.h"

namespace pliant {

namespace {

struct Sum {
  double squares = 0, largest = 0;
  std::int64_t count = 0;
  void add(double value) {
    squares += value * value;
    largest = std::max(largest, std::fabs(value));
    ++count;
  }
  double rms() const { return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0; }
};

/// One object at one iteration.
struct View {
  const CompiledObject& object;
  SweepArguments arguments;
  const LaneValues::value_type* multipliers;  ///< null: none yet, all are zero
  std::vector<Vec3d>& explained;              ///< w grad C^T lambda, by particle
  std::vector<char>& left_out;                ///< particles that something without a multiplier moves
};

/// One constraint, in double: its residual, and what its multiplier moves.
template <class T>
double visit(const View& view, const Pool& pool, std::int64_t batch, int lane, const std::int32_t (&particle)[T::size],
             double multiplier) {
  constexpr int fields = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));
  double rest[fields];
  for (int field = 0; field < fields; ++field) rest[field] = static_cast<double>(pool.row(field, batch)[lane]);
  typename T::template Params<double> params;
  static_assert(sizeof rest == sizeof params);
  std::memcpy(&params, rest, sizeof params);
  Vec3d x[T::size], gradient[T::size];
  const Record& origin = view.arguments.positions[particle[0]];
  for (int slot = 0; slot < T::size; ++slot) {
    const Record &p = view.arguments.positions[particle[slot]], &d = view.arguments.displacements[particle[slot]];
    x[slot] = {double(p.x) - double(origin.x) + double(d.x), double(p.y) - double(origin.y) + double(d.y),
               double(p.z) - double(origin.z) + double(d.z)};
  }
  const double c = T::template evaluate<double>(x, params, gradient);
  for (int slot = 0; slot < T::size; ++slot) {
    const double w = static_cast<double>(view.arguments.positions[particle[slot]].w);
    view.explained[particle[slot]] += gradient[slot] * (w * multiplier);
    if (pool.law == Law::pbd) view.left_out[particle[slot]] = 1;
  }
  if (pool.law == Law::pbd) return c;
  const double compliance = double(pool.row(fields, batch)[lane]) * double(view.arguments.inverse_h2);
  return c + std::min(compliance, double(largest_compliance)) * multiplier;
}

template <class T>
void add_segment(const View& view, const Segment& segment, Sum& sum) {
  const Pool& pool = view.object.pools[segment.pool];
  const bool has = view.multipliers != nullptr && !view.multipliers->empty() && !(*view.multipliers)[segment.pool].empty();
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int b = 0; b < segment.batches; ++b, index += indices_per_batch(pool, segment)) {
    const std::int64_t batch = std::int64_t{segment.first_batch} + b;
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, b, lane)) continue;
      std::int32_t particle[T::size];
      for (int slot = 0; slot < T::size; ++slot) particle[slot] = particle_of(segment, index, slot, lane);
      const double multiplier =
          has ? static_cast<double>((*view.multipliers)[segment.pool][batch * batch_width + lane]) : 0;
      sum.add(visit<T>(view, pool, batch, lane, particle, multiplier));
    }
  }
}

void add_volume(const View& view, double multiplier, Sum& sum) {
  if (!view.object.has_volume) return;
  Records places(view.arguments.positions, view.arguments.positions + view.object.particles);
  for (int i = 0; i < view.object.particles; ++i) {
    const Record& d = view.arguments.displacements[i];
    places[i] = {places[i].x + d.x, places[i].y + d.y, places[i].z + d.z, places[i].w};
  }
  const bool pbd = view.object.volume.law == Law::pbd;
  const double compliance = pbd ? 0 : double(view.object.volume.response) * double(view.arguments.inverse_h2);
  sum.add(volume_error(view.object, places.data()) + std::min(compliance, 1e30) * multiplier);
  for (int i = 0; i < view.object.particles; ++i) {
    const Vec3f g = volume_gradient(view.object, places.data(), i);
    view.explained[i] += Vec3d{g.x, g.y, g.z} * (static_cast<double>(places[i].w) * multiplier);
    if (pbd) view.left_out[i] = 1;
  }
}

/// Displacements since the prediction that no multiplier explains.
void add_unexplained(const View& view, const Record* predicted, Sum& sum) {
  for (int i = 0; i < view.object.particles; ++i) {
    if (!(view.arguments.positions[i].w > 0) || view.left_out[i] != 0) continue;
    const Record &d = view.arguments.displacements[i], &p = predicted[i];
    const Vec3d moved{double(d.x) - double(p.x), double(d.y) - double(p.y), double(d.z) - double(p.z)};
    const Vec3d rest = moved - view.explained[i];
    sum.add(std::sqrt(dot(rest, rest)));
  }
}

Residual residual_of(const std::string& type, const Sum& sum) { return {type, sum.count, sum.rms(), sum.largest}; }

void leave_out_contacts(Frame& frame, std::vector<std::vector<char>>& left_out) {
  for (std::size_t task = 0; task < frame.model().tiles.size(); ++task) {
    for (const Contact& contact : frame.workspace().tiles[task].contacts) {
      if (contact.push > 0) left_out[frame.model().tiles[task].object][contact.particle] = 1;
    }
  }
}

}  // namespace

void record_iteration(Frame& frame, int iteration) {
  const Model& model = frame.model();
  const Workspace& work = frame.workspace();
  const std::size_t objects = model.objects.size();
  std::vector<std::vector<Vec3d>> explained;
  std::vector<std::vector<char>> left_out;
  std::vector<View> views;
  for (const CompiledObject& object : model.objects) {
    explained.emplace_back(object.particles);
    left_out.emplace_back(object.particles, 0);
  }
  leave_out_contacts(frame, left_out);
  for (std::size_t o = 0; o < objects; ++o) {
    views.push_back({model.objects[o], frame.arguments(static_cast<int>(o), false),
                     iteration > 0 ? &work.multipliers[o] : nullptr, explained[o], left_out[o]});
  }
  IterationResidual found;
  found.iteration = iteration;
  for_each_type(AllConstraints{}, [&](auto tag, int type) {
    using T = typename decltype(tag)::type;
    Sum sum;
    for (const View& view : views) {
      for (const Segment& segment : view.object.segments) {
        if (view.object.pools[segment.pool].type == type) add_segment<T>(view, segment, sum);
      }
    }
    if (sum.count > 0) found.primal.push_back(residual_of(T::name, sum));
  });
  Sum volumes, dual;
  for (std::size_t o = 0; o < objects; ++o) {
    add_volume(views[o], iteration > 0 ? work.volume_multipliers[o] : 0, volumes);
    add_unexplained(views[o], work.sweep.predicted.data() + model.first[o], dual);
  }
  if (volumes.count > 0) found.primal.push_back(residual_of("volume", volumes));
  found.dual_rms = dual.rms();
  found.dual_largest = dual.largest;
  frame.report().convergence.push_back(std::move(found));
}

void record_prediction(Frame& frame) {
  std::copy(frame.workspace().displacements.begin(), frame.workspace().displacements.end(),
            frame.scratch().predicted.begin());
  record_iteration(frame, 0);
}

}  // namespace pliant
