#include "solver/sweeps/record.h"

#include <algorithm>
#include <cmath>

#include "constraints/all.h"
#include "solver/substep.h"
#include "solver/visit.h"
#include "solver/volume.h"

namespace pliant {

namespace {

/// One object at one iteration.
struct View {
  const CompiledObject& object;
  SweepArguments arguments;
  const std::vector<AlignedVector<float>>* multipliers;  ///< null: none yet, all are zero
  std::vector<Vec3d>& explained;                         ///< w grad C^T lambda, by particle
  std::vector<char>& left_out;                           ///< particles that something without a multiplier moves
};

/// One constraint, in double: its residual, and what its multiplier moves.
template <class T>
double look_at(const View& view, const ConstraintPlace& at, const std::int32_t (&particle)[T::size], double multiplier) {
  Vec3d x[T::size], gradient[T::size];
  const Record& origin = view.arguments.positions[particle[0]];
  for (int slot = 0; slot < T::size; ++slot) {
    const Record &p = view.arguments.positions[particle[slot]], &d = view.arguments.displacements[particle[slot]];
    x[slot] = {double(p.x) - double(origin.x) + double(d.x), double(p.y) - double(origin.y) + double(d.y),
               double(p.z) - double(origin.z) + double(d.z)};
  }
  const double c = T::template evaluate<double>(x, rest_data<T, double>(at), gradient);
  for (int slot = 0; slot < T::size; ++slot) {
    const double w = static_cast<double>(view.arguments.positions[particle[slot]].w);
    view.explained[particle[slot]] += gradient[slot] * (w * multiplier);
    if (at.pool.law == Law::pbd) view.left_out[particle[slot]] = 1;
  }
  return at.pool.law == Law::pbd ? c : c + softness<T>(at, double(view.arguments.inverse_h2)) * multiplier;
}

template <class T>
void add_constraints(const View& view, int type, ErrorSum& sum) {
  for_constraints<T>(view.object, type, [&](const ConstraintPlace& at, const auto& particle) {
    const bool has =
        view.multipliers != nullptr && !view.multipliers->empty() && !(*view.multipliers)[at.pool_number].empty();
    const double multiplier = has ? static_cast<double>((*view.multipliers)[at.pool_number][at.lane_in_pool()]) : 0;
    sum.add(look_at<T>(view, at, particle, multiplier));
  });
}

void add_volume(const View& view, double multiplier, ErrorSum& sum) {
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
void add_unexplained(const View& view, const Record* predicted, ErrorSum& sum) {
  for (int i = 0; i < view.object.particles; ++i) {
    if (!(view.arguments.positions[i].w > 0) || view.left_out[i] != 0) continue;
    const Record &d = view.arguments.displacements[i], &p = predicted[i];
    const Vec3d moved{double(d.x) - double(p.x), double(d.y) - double(p.y), double(d.z) - double(p.z)};
    const Vec3d rest = moved - view.explained[i];
    sum.add(std::sqrt(dot(rest, rest)));
  }
}

void leave_out_contacts(Substep& s, std::vector<std::vector<char>>& left_out) {
  for (std::size_t task = 0; task < s.model.tiles.size(); ++task) {
    for (const Contact& contact : s.work.tiles[task].contacts) {
      if (contact.push > 0) left_out[s.model.tiles[task].object][contact.point[0]] = 1;
    }
  }
}

}  // namespace

void record_iteration(Substep& s, int iteration) {
  const Model& model = s.model;
  const Workspace& work = s.work;
  const std::size_t objects = model.objects.size();
  std::vector<std::vector<Vec3d>> explained;
  std::vector<std::vector<char>> left_out;
  std::vector<View> views;
  for (const CompiledObject& object : model.objects) {
    explained.emplace_back(object.particles);
    left_out.emplace_back(object.particles, 0);
  }
  leave_out_contacts(s, left_out);
  for (std::size_t o = 0; o < objects; ++o) {
    views.push_back({model.objects[o], arguments(s, static_cast<int>(o), false),
                     iteration > 0 ? &work.multipliers[o] : nullptr, explained[o], left_out[o]});
  }
  IterationResidual found;
  found.iteration = iteration;
  for_each_type(AllConstraints{}, [&](auto tag, int type) {
    using T = typename decltype(tag)::type;
    ErrorSum sum;
    for (const View& view : views) add_constraints<T>(view, type, sum);
    if (sum.count > 0) found.primal.push_back(sum.residual(T::name));
  });
  ErrorSum volumes, dual;
  for (std::size_t o = 0; o < objects; ++o) {
    add_volume(views[o], iteration > 0 ? work.volume_multipliers[o] : 0, volumes);
    add_unexplained(views[o], work.predicted.data() + model.first[o], dual);
  }
  if (volumes.count > 0) found.primal.push_back(volumes.residual("volume"));
  found.dual_rms = dual.rms();
  found.dual_largest = dual.largest;
  s.report.convergence.push_back(std::move(found));
}

void record_prediction(Substep& s) {
  std::copy(s.work.displacements.begin(), s.work.displacements.end(), s.work.predicted.begin());
  record_iteration(s, 0);
}

}  // namespace pliant
