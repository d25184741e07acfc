#include "solver/measure.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "constraints/all.h"
#include "solver/project.h"
#include "solver/volume.h"

namespace pliant {

namespace {

/// Calls visit(x, params, response, number of the lane in the pool) for every constraint of a pool of type T.
template <class T, class Visit>
void for_constraints(const CompiledObject& object, const Pool& pool, int pool_number, const Record* positions,
                     const Visit& visit) {
  constexpr int fields = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));
  for (const Segment& segment : object.segments) {
    if (segment.pool != pool_number) continue;
    const std::int32_t* index = pool.indices.data() + segment.index_offset;
    for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
      const std::int64_t number = segment.first_batch + batch;
      for (int lane = 0; lane < batch_width; ++lane) {
        if (!lane_is_valid(segment, batch, lane)) continue;
        float rest[fields];
        for (int field = 0; field < fields; ++field) rest[field] = pool.row(field, number)[lane];
        typename T::template Params<float> params;
        std::memcpy(&params, rest, sizeof params);
        Vec3f x[T::size];
        for (int slot = 0; slot < T::size; ++slot) {
          const Record& p = positions[particle_of(segment, index, slot, lane)];
          x[slot] = {p.x, p.y, p.z};
        }
        visit(x, params, pool.row(fields, number)[lane], number * batch_width + lane);
      }
    }
  }
}

struct Sum {
  double squares = 0, largest = 0;
  std::int64_t count = 0;
  void add(double c) {
    squares += c * c;
    largest = std::max(largest, std::fabs(c));
    ++count;
  }
  Residual residual(const char* type) const {
    return {type, count, count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0, largest};
  }
};

template <class T>
void add_residuals(const CompiledObject& object, int pool_number, const Record* positions, const float* multipliers,
                   float h, Sum& sum) {
  const Pool& pool = object.pools[pool_number];
  for_constraints<T>(object, pool, pool_number, positions,
                     [&](const auto& x, const auto& params, float response, auto lane) {
                       Vec3f gradient[T::size];
                       double c = T::evaluate(x, params, gradient);
                       if (multipliers != nullptr && pool.law != Law::pbd) {
                         c += std::min(double(response) / (double(h) * h), double(largest_compliance)) * multipliers[lane];
                       }
                       sum.add(c);
                     });
}

}  // namespace

std::vector<Residual> measure_residuals(const Model& model, const State& state, const Workspace& workspace, float h) {
  std::vector<Residual> residuals;
  for_each_type(AllConstraints{}, [&](auto tag, int type) {
    using T = typename decltype(tag)::type;
    Sum sum;
    for (std::size_t o = 0; o < model.objects.size(); ++o) {
      const CompiledObject& object = model.objects[o];
      for (std::size_t p = 0; p < object.pools.size(); ++p) {
        if (object.pools[p].type != type) continue;
        const bool kept = !workspace.multipliers[o].empty() && !workspace.multipliers[o][p].empty();
        const float* multipliers = kept ? workspace.multipliers[o][p].data() : nullptr;
        add_residuals<T>(object, static_cast<int>(p), state.positions.data() + model.first[o], multipliers, h, sum);
      }
    }
    if (sum.count > 0) residuals.push_back(sum.residual(T::name));
  });
  Sum volumes;
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    if (!object.has_volume) continue;
    const double softness = std::min(double(object.volume.response) / (double(h) * h), double(largest_compliance));
    const double compliance = object.volume.law == Law::pbd ? 0 : softness;
    volumes.add(volume_error(object, state.positions.data() + model.first[o]) +
                compliance * workspace.volume_multipliers[o]);
  }
  if (volumes.count > 0) residuals.push_back(volumes.residual("volume"));
  return residuals;
}

Stretch measure_stretch(const Model& model, const State& state) {
  std::vector<float> ratios;
  double sum = 0;
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    for (std::size_t p = 0; p < object.pools.size(); ++p) {
      bool is_distance = false;
      with_type(AllConstraints{}, object.pools[p].type,
                [&](auto tag) { is_distance = std::is_same_v<typename decltype(tag)::type, Distance>; });
      if (!is_distance) continue;
      for_constraints<Distance>(object, object.pools[p], static_cast<int>(p), state.positions.data() + model.first[o],
                                [&](const auto& x, const auto& params, float, auto) {
                                  if (!(params.rest_length > 0)) return;
                                  const Vec3f d = x[1] - x[0];
                                  ratios.push_back(std::sqrt(dot(d, d)) / params.rest_length);
                                  sum += ratios.back();
                                });
    }
  }
  if (ratios.empty()) return {};
  Stretch stretch;
  stretch.mean = sum / static_cast<double>(ratios.size());
  const auto at_p99 = ratios.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(ratios.size() - 1));
  std::nth_element(ratios.begin(), at_p99, ratios.end());
  stretch.p99 = *at_p99;
  stretch.largest = *std::max_element(at_p99, ratios.end());
  return stretch;
}

double measure_volume(const CompiledObject& object, const Record* positions) {
  return object.particles > 0 ? (volume_error(object, positions) + object.volume.target) / 6 : 0;
}

}  // namespace pliant
