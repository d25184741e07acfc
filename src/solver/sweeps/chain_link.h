// One link of a chain and one tether, written once for a float and for sixteen lanes.
//
// A path of distances is solved exactly: (J W J^T + alpha~) dlambda = -C - alpha~ lambda is tridiagonal, with the diagonal
// w_k + w_{k+1} + alpha~ and beside it -w_k (n_{k-1} . n_k), and Thomas's elimination solves it forwards and back (the
// direct solver of Macklin et al. 2016's system along a line; Deul et al. 2018 do the same for rods).
//
// The pivot is not formed as a difference. With q_k the mobility of link k's first end when all before it holds,
//   p_k = q_k + w_{k+1} + s_k,   q_k = w_k - (w_k n_{k-1}.n_k)^2 / p_{k-1} = w_k (q_{k-1} + s_{k-1} + w_k |n_{k-1} x
//   n_k|^2) / p_{k-1},
// where s_k is what is added to the diagonal: sums of what is not negative, so that a load 100 000 times as heavy as a
// link, whose pivot is the hundred-thousandth part of what the difference would be taken of, keeps all its digits.
#pragma once

#include "math/scalar.h"
#include "model/compiled_object.h"
#include "solver/project.h"

namespace pliant {

/// What link k + 1 needs of link k.
template <class R>
struct ChainEnd {
  Vec3<R> direction;  ///< n_k
  R length;           ///< of the link now; zero: it has no direction
  R weight;           ///< inverse mass of the particle between
  R mobility;         ///< q_k
  R added;            ///< s_k
  R inverse_pivot;    ///< 1 / p_k
  R change;           ///< dlambda_k as if no link followed
};

/// What is kept of a link for the way back.
template <class R>
struct ChainLink {
  Vec3<R> direction;
  R weight;    ///< inverse mass of the particle at its end
  R change;    ///< dlambda as if no link followed
  R coupling;  ///< by which its dlambda counts in that of the link before
};

/// The numbers of a link.
template <class R>
struct ChainParams {
  R rest_length, compliance, softness, multiplier;
};

/// Eliminates a link: `across` from its first particle to its second, whose inverse mass is `weight`. `end` is that of the
/// link before, or for the first link has zero in all but `weight`.
template <bool first, class R>
PLIANT_HD ChainLink<R> eliminate(const Vec3<R>& across, const R& weight, const ChainParams<R>& params,
                                 const SweepArguments& a, ChainEnd<R>& end) {
  const R tiny(smallest_denominator), w = end.weight;
  const R length = sqrt(dot(across, across));
  const Vec3<R> n = across * (R(1) / max(length, tiny));
  R mobility = w, coupled(0), coupling(0);
  if constexpr (!first) {
    // Where a link has no direction the two do not know of one another: as if they stood at right angles.
    const R sine2 = select(min(length, end.length) < tiny, R(1), length_squared(cross(end.direction, n)));
    coupled = w * dot(end.direction, n);
    mobility = w * ((end.mobility + end.added + w * sine2) * end.inverse_pivot);
    coupling = coupled * end.inverse_pivot;
  }
  const R compliance = min(params.compliance * R(a.inverse_h2), R(largest_compliance));
  const R added = params.softness + compliance;
  const R inverse_pivot = R(1) / max(mobility + weight + added, tiny);
  R numerator = params.rest_length - length - compliance * params.multiplier;
  if constexpr (!first) numerator = numerator + coupled * end.change;
  const R change = numerator * inverse_pivot;
  end = {n, length, weight, mobility, added, inverse_pivot, change};
  return {n, weight, change, coupling};
}

/// How far a particle is to be moved along a tether: (x - anchor) times this share.
template <class R>
PLIANT_HD R tether_share(const R& distance, const R& longest) {
  return (longest - distance) / max(distance, R(smallest_denominator));
}

/// One particle's tethers, one after the other. `anchors` holds a position and a displacement each.
PLIANT_HD void hold_particle(const Tethers& tethers, int batch, int lane, int particle, const Record* anchors,
                             const SweepArguments& a) {
  const Record& x = a.positions[particle];
  Record& d = a.displacements[particle];
  for (int slot = 0; slot < tethers.slots; ++slot) {
    const std::size_t row = static_cast<std::size_t>(batch) * tethers.slots + slot;
    const Tethers::Row& of = tethers.rows.data()[row];
    const Record* anchor = anchors + 2 * (of.anchor >= 0 ? of.anchor : tethers.lane_anchors.data()[of.lanes + lane]);
    const Vec3f away{(x.x - anchor[0].x) + (d.x - anchor[1].x), (x.y - anchor[0].y) + (d.y - anchor[1].y),
                     (x.z - anchor[0].z) + (d.z - anchor[1].z)};
    const float longest = tethers.lengths.data()[row * batch_width + lane];
    const float distance = sqrt(dot(away, away));
    if (!(distance > longest)) continue;
    const float share = tether_share(distance, longest);
    d = {d.x + away.x * share, d.y + away.y * share, d.z + away.z * share, 0};
  }
}

}  // namespace pliant
