#include "solver/measure.h"

#include <algorithm>
#include <cmath>

#include "constraints/registry.h"
#include "solver/visit.h"
#include "solver/volume.h"

namespace pliant {

namespace {

/// A view of an object's particles and of its multipliers of the last substep.
struct View {
  const CompiledObject& object;
  const Record *positions, *velocities, *orientations;
  const std::vector<AlignedVector<float>>& multipliers;  ///< multipliers of each pool, empty if they are not stored
  double h;

  double multiplier(const ConstraintPlace& at, int component = 0) const {
    if (at.pool.law == Law::pbd || multipliers.empty() || multipliers[at.pool_number].empty()) return 0;
    return static_cast<double>(multipliers[at.pool_number][at.multiplier_place(component)]);
  }
};

View view_of(const Model& model, const State& state, const Workspace& workspace, std::size_t o, float h) {
  const int first = model.first[o];
  return {model.objects[o],
          state.positions.data() + first,
          state.velocities.data() + first,
          state.frames.orientations.data() + model.first_frame[o],
          workspace.multipliers[o],
          double(h)};
}

Vec3f place_of(const Record& p) { return {p.x, p.y, p.z}; }

/// Adds the norm of C + alpha~ lambda of every constraint of a type; C is a vector if the type has several rows.
void add_residuals(const View& view, int type, ErrorSum& sum) {
  const auto evaluate = constraint_type(type).evaluate;
  StencilArrays<float> arrays;
  for_constraints(view.object, type, [&](const ConstraintPlace& at, const std::int32_t* particle) {
    for (int slot = 0; slot < at.pool.stencil; ++slot) {
      const bool is_frame = particle[slot] >= view.object.particles;
      const Record& p =
          is_frame ? view.orientations[particle[slot] - view.object.particles] : view.positions[particle[slot]];
      arrays.set_slot(slot, p.x, p.y, p.z, p.w);
    }
    arrays.load_rest(at);
    evaluate(arrays.slots, arrays.rest, arrays.c, arrays.gradients);
    double squared = 0, error = 0;
    for (int component = 0; component < at.pool.components; ++component) {
      const double c = static_cast<double>(arrays.c[component]), multiplier = view.multiplier(at, component);
      error = multiplier != 0 ? c + softness(at, 1 / (view.h * view.h)) * multiplier : c;
      squared += error * error;
    }
    sum.add(at.pool.components == 1 ? error : std::sqrt(squared));
  });
}

ErrorSum volume_errors(const Model& model, const State& state, const Workspace& workspace, FunctionRef<float(int)> h_of) {
  ErrorSum volumes;
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    if (!object.has_volume) continue;
    const float h = h_of(static_cast<int>(o));
    const double softness = std::min(double(object.volume.response) / (double(h) * h), double(largest_compliance));
    const double compliance = object.volume.law == Law::pbd ? 0 : softness;
    volumes.add(volume_error(object, state.positions.data() + model.first[o]) +
                compliance * workspace.volume_multipliers[o]);
  }
  return volumes;
}

/// The relative length of a distance constraint beyond what its force explains. Damping explains alpha beta times the
/// speed along it.
double excess_of(const View& view, const ConstraintPlace& at, const std::int32_t* particle, double length, double rest) {
  const double compliance = at.value(at.pool.fields);
  double explained = softness(at, 1 / (view.h * view.h)) * view.multiplier(at);
  if (at.pool.law == Law::damped && length > 0) {
    const Vec3f way = place_of(view.positions[particle[1]]) - place_of(view.positions[particle[0]]);
    const Vec3f speed = place_of(view.velocities[particle[1]]) - place_of(view.velocities[particle[0]]);
    explained += compliance * double(at.value(at.pool.fields + 1)) * double(dot(way, speed)) / length;
  }
  return (length - rest + explained) / rest;
}

void add_lengths(const View& view, int number, int type, Lengths& lengths, double& sum) {
  for_constraints(view.object, type, [&](const ConstraintPlace& at, const std::int32_t* particle) {
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

/// Returns the 99th percentile of the values, which are reordered.
double take_p99(std::vector<float>& values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::vector<Residual> measure_residuals(const Model& model, const State& state, const Workspace& workspace,
                                        FunctionRef<float(int)> h) {
  std::vector<Residual> residuals;
  for (int type = 0; type < constraint_type_count(); ++type) {
    ErrorSum sum;
    for (std::size_t o = 0; o < model.objects.size(); ++o)
      add_residuals(view_of(model, state, workspace, o, h(static_cast<int>(o))), type, sum);
    if (sum.count > 0) residuals.push_back(sum.residual(constraint_type(type).name));
  }
  const ErrorSum volumes = volume_errors(model, state, workspace, h);
  if (volumes.count > 0) residuals.push_back(volumes.residual("volume"));
  return residuals;
}

void measure_lengths(const Model& model, const State& state, const Workspace& workspace, FunctionRef<float(int)> h,
                     Lengths& lengths) {
  lengths.stretch = {};
  lengths.overstretch = {};
  lengths.ratios.clear();
  lengths.excesses.clear();
  double sum = 0;
  for (int type = 0; type < constraint_type_count(); ++type) {
    for (std::size_t o = 0; is_length(type) && o < model.objects.size(); ++o)
      add_lengths(view_of(model, state, workspace, o, h(static_cast<int>(o))), static_cast<int>(o), type, lengths, sum);
  }
  if (lengths.ratios.empty()) return;
  lengths.stretch.mean = sum / static_cast<double>(lengths.ratios.size());
  lengths.stretch.p99 = take_p99(lengths.ratios);
  lengths.stretch.largest = *std::max_element(lengths.ratios.begin(), lengths.ratios.end());
  if (!lengths.excesses.empty()) lengths.overstretch.p99 = take_p99(lengths.excesses);
}

double measure_volume(const CompiledObject& object, const Record* positions) {
  double six = 0;
  const auto from_first = [&](int particle) {
    const Record &x = positions[particle], &first = positions[0];
    return Vec3d{double(x.x) - first.x, double(x.y) - first.y, double(x.z) - first.z};
  };
  for (const auto& t : object.surface.triangles) six += dot(from_first(t[0]), cross(from_first(t[1]), from_first(t[2])));
  return six / 6;
}

}  // namespace pliant
