#include "solver/measure.h"

#include <algorithm>
#include <cmath>

#include "constraints/registry.h"
#include "math/record.h"
#include "solver/visit.h"
#include "solver/volume.h"

namespace pliant {

namespace {

/// A view of an object's particles and of its multipliers of the last substep.
struct StateView {
  const CompiledObject& object;
  const Record *positions, *orientations;
  const std::vector<AlignedVector<float>>& multipliers;  ///< multipliers of each pool, empty if they are not stored
  double h;

  double multiplier(const ConstraintPlace& at, int component = 0) const {
    if (at.pool.law == Law::pbd || multipliers.empty() || multipliers[at.pool_number].empty()) return 0;
    return static_cast<double>(multipliers[at.pool_number][at.multiplier_place(component)]);
  }
};

StateView view_of(const Model& model, const State& state, const Workspace& workspace, std::size_t o, float h) {
  const int first = model.first[o];
  return {model.objects[o], state.positions.data() + first, state.frames.orientations.data() + model.first_frame[o],
          workspace.multipliers[o], double(h)};
}

/// Evaluates C. It is zero where the force that would reduce it is excluded by a bound, as within a joint's limits.
void evaluate(const ConstraintDefinition& type, StencilArrays<float>& arrays, float (&bounds)[3 * most_components]) {
  if (type.evaluate_bounded == nullptr) return type.evaluate(arrays.slots, arrays.rest, arrays.c, arrays.gradients);
  type.evaluate_bounded(arrays.slots, arrays.rest, arrays.c, arrays.gradients, bounds);
  for (int row = 0; row < type.rows; ++row) {
    float& c = arrays.c[row];
    if ((c > 0 && !(bounds[3 * row] < 0)) || (c < 0 && !(bounds[3 * row + 1] > 0))) c = 0;
  }
}

/// Adds the norm of C + alpha~ lambda of every constraint of a type; C is a vector if the type has several rows.
void add_residuals(const StateView& view, int type, ErrorSum& sum) {
  const ConstraintDefinition& definition = constraint_type(type);
  if (definition.acts_on_motion) return;  // imposes a speed, which has no C to be met
  StencilArrays<float> arrays;
  float bounds[3 * most_components];
  for_constraints(view.object, type, [&](const ConstraintPlace& at, const std::int32_t* particle) {
    for (int slot = 0; slot < at.pool.stencil; ++slot) {
      const bool is_frame = particle[slot] >= view.object.particles;
      const Record& p =
          is_frame ? view.orientations[particle[slot] - view.object.particles] : view.positions[particle[slot]];
      arrays.set_slot(slot, p.x, p.y, p.z, p.w);
    }
    arrays.load_rest(at);
    evaluate(definition, arrays, bounds);
    double squared = 0, error = 0;
    for (int component = 0; component < at.pool.components; ++component) {
      const double c = static_cast<double>(arrays.c[component]), multiplier = view.multiplier(at, component);
      error = multiplier != 0 ? c + softness(at, 1 / (view.h * view.h)) * multiplier : c;
      squared += error * error;
    }
    sum.add(at.pool.components == 1 ? error : std::sqrt(squared));
  });
}

ErrorSum volume_errors(const Model& model, const State& state, const Workspace& workspace,
                       FunctionRef<float(int)> h_of) {
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

void add_ratios(const CompiledObject& object, const Record* positions, int type, std::vector<float>& ratios,
                double& sum) {
  for_constraints(object, type, [&](const ConstraintPlace& at, const std::int32_t* particle) {
    const float rest = at.value(0);
    if (!(rest > 0)) return;
    const Vec3f way = xyz(positions[particle[1]]) - xyz(positions[particle[0]]);
    ratios.push_back(std::sqrt(dot(way, way)) / rest);
    sum += static_cast<double>(ratios.back());
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

Stretch measure_stretch(const Model& model, const State& state, std::vector<float>& ratios) {
  Stretch stretch;
  ratios.clear();
  double sum = 0;
  for (int type = 0; type < constraint_type_count(); ++type) {
    for (std::size_t o = 0; is_length(type) && o < model.objects.size(); ++o)
      add_ratios(model.objects[o], state.positions.data() + model.first[o], type, ratios, sum);
  }
  if (ratios.empty()) return stretch;
  stretch.mean = sum / static_cast<double>(ratios.size());
  stretch.p99 = take_p99(ratios);
  stretch.largest = *std::max_element(ratios.begin(), ratios.end());
  return stretch;
}

double measure_volume(const CompiledObject& object, const Record* positions) {
  double six = 0;
  const auto from_first = [&](int particle) {
    const Record &x = positions[particle], &first = positions[0];
    return Vec3d{double(x.x) - first.x, double(x.y) - first.y, double(x.z) - first.z};
  };
  for (const auto& t : object.surface.triangles)
    six += dot(from_first(t[0]), cross(from_first(t[1]), from_first(t[2])));
  return six / 6;
}

}  // namespace pliant
