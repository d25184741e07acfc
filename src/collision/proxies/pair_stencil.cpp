#include "collision/proxies/pair_stencil.h"

#include "collision/proxies/pair_kernels.h"
#include "geometry/triangle.h"
#include "levels/compiled.h"

namespace pliant {

namespace {

Vec3d place(const Record& r, const Record& origin) {
  return {double(r.x) - double(origin.x), double(r.y) - double(origin.y), double(r.z) - double(origin.z)};
}

}  // namespace

PairDistance pair_distance(const PairStencil& pair, const Record* positions) {
  const Record& origin = positions[pair.vertex[0]];
  Vec3d x[4];
  for (int i = 0; i < 4; ++i) x[i] = place(positions[pair.vertex[i]], origin);
  PairDistance out;
  Vec3d apart;
  if (pair.first_side == 1) {
    const auto near = closest_on_triangle(x[0], x[1], x[2], x[3]);
    out.weight = {1, -near.weights.x, -near.weights.y, -near.weights.z};
    apart = x[0] - near.point;
  } else {
    const auto near = closest_on_segments({x[0], x[1]}, {x[2], x[3]});
    out.weight = {1 - near.s, near.s, near.t - 1, -near.t};
    apart = near.first - near.second;
  }
  out.distance = length(apart);
  out.normal = out.distance > 1e-30 ? apart * (1 / out.distance) : Vec3d{};
  return out;
}

const PairKernels& base_pair_kernels() { return PLIANT_OF_BASE_LEVEL(pair_kernels)(); }

void pair_distances(const PairStencil* pairs, int count, const Record* positions, PairBatch& out) {
  PairStencils batch;
  for (int lane = 0; lane < 16; ++lane)
    for (int i = 0; i < 4; ++i) batch.vertex[i][lane] = pairs[lane < count ? lane : 0].vertex[i];
  base_pair_kernels().distances(batch, pairs[0].first_side, positions, out);
}

}  // namespace pliant
