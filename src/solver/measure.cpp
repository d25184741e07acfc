#include "solver/measure.h"

#include <algorithm>
#include <cmath>

#include "constraints/all.h"
#include "solver/visit.h"
#include "solver/volume.h"

namespace pliant {

namespace {

/// An object's particles and what its constraints pulled with in the last substep.
struct View {
  const CompiledObject& object;
  const Record *positions, *velocities;
  const std::vector<AlignedVector<float>>& multipliers;  ///< by pool, empty where none is kept
  double h;

  double multiplier(const ConstraintPlace& at) const {
    if (at.pool.law == Law::pbd || multipliers.empty() || multipliers[at.pool_number].empty()) return 0;
    return static_cast<double>(multipliers[at.pool_number][at.lane_in_pool()]);
  }
};

View view_of(const Model& model, const State& state, const Workspace& workspace, std::size_t o, float h) {
  const int first = model.first[o];
  return {model.objects[o], state.positions.data() + first, state.velocities.data() + first, workspace.multipliers[o],
          double(h)};
}

Vec3f place_of(const Record& p) { return {p.x, p.y, p.z}; }

template <class T>
void add_residuals(const View& view, int type, ErrorSum& sum) {
  for_constraints<T>(view.object, type, [&](const ConstraintPlace& at, const auto& particle) {
    Vec3f x[T::size], gradient[T::size];
    for (int slot = 0; slot < T::size; ++slot) x[slot] = place_of(view.positions[particle[slot]]);
    const double c = T::evaluate(x, rest_data<T, float>(at), gradient), multiplier = view.multiplier(at);
    sum.add(multiplier != 0 ? c + softness<T>(at, 1 / (view.h * view.h)) * multiplier : c);
  });
}

ErrorSum volume_errors(const Model& model, const State& state, const Workspace& workspace, float h) {
  ErrorSum volumes;
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    if (!object.has_volume) continue;
    const double softness = std::min(double(object.volume.response) / (double(h) * h), double(largest_compliance));
    const double compliance = object.volume.law == Law::pbd ? 0 : softness;
    volumes.add(volume_error(object, state.positions.data() + model.first[o]) +
                compliance * workspace.volume_multipliers[o]);
  }
  return volumes;
}

/// One distance: by how much it is longer than its force makes it. Damping's part is alpha beta times the speed along it.
double excess_of(const View& view, const ConstraintPlace& at, const std::int32_t (&particle)[2], double length,
                 double rest) {
  const double compliance = at.value(rest_fields<Distance>);
  double explained = softness<Distance>(at, 1 / (view.h * view.h)) * view.multiplier(at);
  if (at.pool.law == Law::damped && length > 0) {
    const Vec3f way = place_of(view.positions[particle[1]]) - place_of(view.positions[particle[0]]);
    const Vec3f speed = place_of(view.velocities[particle[1]]) - place_of(view.velocities[particle[0]]);
    explained += compliance * double(at.value(rest_fields<Distance> + 1)) * double(dot(way, speed)) / length;
  }
  return (length - rest + explained) / rest;
}

void add_lengths(const View& view, int number, int type, Lengths& lengths, double& sum) {
  for_constraints<Distance>(view.object, type, [&](const ConstraintPlace& at, const auto& particle) {
    const float rest = at.value(0);
    if (!(rest > 0)) return;
    const Vec3f way = place_of(view.positions[particle[1]]) - place_of(view.positions[particle[0]]);
    const float length = std::sqrt(dot(way, way));
    lengths.ratios.push_back(length / rest);
    sum += lengths.ratios.back();
    if (at.pool.law == Law::pbd) return;
    const double excess = excess_of(view, at, particle, length, rest);
    lengths.excesses.push_back(static_cast<float>(excess));
    Overstretch& worst = lengths.overstretch;
    if (worst.object >= 0 && !(excess > worst.largest)) return;
    worst.largest = excess;
    worst.object = number;
    worst.particles = {view.object.order[particle[0]], view.object.order[particle[1]]};
  });
}

/// The value below which 99 in a hundred lie. Leaves those above it behind it.
double take_p99(std::vector<float>& values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::vector<Residual> measure_residuals(const Model& model, const State& state, const Workspace& workspace, float h) {
  std::vector<Residual> residuals;
  for_each_type(AllConstraints{}, [&](auto tag, int type) {
    using T = typename decltype(tag)::type;
    ErrorSum sum;
    for (std::size_t o = 0; o < model.objects.size(); ++o)
      add_residuals<T>(view_of(model, state, workspace, o, h), type, sum);
    if (sum.count > 0) residuals.push_back(sum.residual(T::name));
  });
  const ErrorSum volumes = volume_errors(model, state, workspace, h);
  if (volumes.count > 0) residuals.push_back(volumes.residual("volume"));
  return residuals;
}

void measure_lengths(const Model& model, const State& state, const Workspace& workspace, float h, Lengths& lengths) {
  lengths.stretch = {};
  lengths.overstretch = {};
  lengths.ratios.clear();
  lengths.excesses.clear();
  double sum = 0;
  for_each_type(AllConstraints{}, [&](auto tag, int type) {
    if constexpr (std::is_same_v<typename decltype(tag)::type, Distance>) {
      for (std::size_t o = 0; o < model.objects.size(); ++o)
        add_lengths(view_of(model, state, workspace, o, h), static_cast<int>(o), type, lengths, sum);
    }
  });
  if (lengths.ratios.empty()) return;
  lengths.stretch.mean = sum / static_cast<double>(lengths.ratios.size());
  lengths.stretch.p99 = take_p99(lengths.ratios);
  lengths.stretch.largest = *std::max_element(lengths.ratios.begin(), lengths.ratios.end());
  if (!lengths.excesses.empty()) lengths.overstretch.p99 = take_p99(lengths.excesses);
}

double measure_volume(const CompiledObject& object, const Record* positions) {
  return object.particles > 0 ? (volume_error(object, positions) + object.volume.target) / 6 : 0;
}

}  // namespace pliant
