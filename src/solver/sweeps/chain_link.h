// One link of a chain and one tether, written once for a float and for sixteen lanes.
//
// A path of distance constraints is solved exactly: (J W J^T + alpha~) dlambda = -C - alpha~ lambda is tridiagonal,
// with the diagonal w_k + w_{k+1} + alpha~ and the off-diagonal -w_k (n_{k-1} . n_k). The Thomas algorithm solves it (a
// direct solver for the system of Macklin et al. 2016 along a path; Deul et al. 2018 do the same for rods).
//
// The pivot avoids a difference. q_k is the mobility of link k's first end while earlier links are satisfied:
//   p_k = q_k + w_{k+1} + s_k,   q_k = w_k - (w_k n_{k-1}.n_k)^2 / p_{k-1} = w_k (q_{k-1} + s_{k-1} + w_k |n_{k-1} x
//   n_k|^2) / p_{k-1},
// s_k is the term added to the diagonal. All terms are sums of non-negative values, so no digits cancel. For a load 100
// 000 times as heavy as a link, a pivot computed as a difference would be a hundred-thousandth of its two terms.
#pragma once

#include "math/scalar.h"
#include "model/compiled_object.h"
#include "solver/project.h"

namespace pliant {

/// The limit of stiffness up to which links have the mean of forces (energy_law.h). A path is solved exactly, crossing
/// paths are not.
inline constexpr float most_of_chain = 10;

/// Results of link k that link k + 1 needs.
template <class R>
struct ChainEnd {
  Vec3<R> direction;  ///< n_k, unit vector along link k
  R length;           ///< current length of link k; zero: no direction
  R weight;           ///< inverse mass of the particle between links k and k + 1
  R mobility;         ///< q_k, mobility of the first end
  R added;            ///< s_k, added to the diagonal
  R inverse_pivot;    ///< 1 / p_k, inverse of the pivot
  R change;           ///< dlambda_k if no link followed
};

/// Results of a link that back substitution needs.
template <class R>
struct ChainLink {
  Vec3<R> direction;
  R weight;    ///< inverse mass of the link's second particle
  R change;    ///< dlambda of the link if no link followed
  R coupling;  ///< factor by which this link's dlambda changes that of the previous link
};

/// The parameters of one link.
template <class R>
struct ChainParams {
  R rest_length, compliance, softness, multiplier;
  Vec3<R> motion{},
      coast{};  ///< with Integrator::energy: displacements of the second particle less those of the first (energy_law.h)
};

/// Eliminates a link. `across`: from its first particle to its second, whose inverse mass is `weight`. `end`: results
/// of the previous link (before the first link zero, but for the weight); replaced by those of this link.
template <bool first, class R>
PLIANT_HD ChainLink<R> eliminate(const Vec3<R>& across, const R& weight, const ChainParams<R>& params,
                                 const SweepArguments& a, ChainEnd<R>& end) {
  const R tiny(smallest_denominator), w = end.weight;
  const R length = sqrt(dot(across, across));
  const Vec3<R> n = across * (R(1) / max(length, tiny));
  R mobility = w, coupled(0), coupling(0);
  if constexpr (!first) {
    // A link of length zero is decoupled from its neighbour, as if the two were perpendicular.
    const R sine2 = select(min(length, end.length) < tiny, R(1), length_squared(cross(end.direction, n)));
    coupled = w * dot(end.direction, n);
    mobility = w * ((end.mobility + end.added + w * sine2) * end.inverse_pivot);
    coupling = coupled * end.inverse_pivot;
  }
  R compliance = min(params.compliance * R(a.inverse_h2), R(largest_compliance));
  R numerator = params.rest_length - length - compliance * params.multiplier;
  if (a.keeps_energy) {
    const auto mean = energy_law::shares_of(compliance, R(w + weight), R(most_of_chain));
    const R share = R(1) / (R(1) - mean.motion);
    numerator = (numerator + (mean.motion * dot(n, params.motion) + mean.coast * dot(n, params.coast))) * share;
    compliance = compliance * share;
  }
  const R added = params.softness + compliance;
  const R inverse_pivot = R(1) / max(mobility + weight + added, tiny);
  if constexpr (!first) numerator = numerator + coupled * end.change;
  const R change = numerator * inverse_pivot;
  end = {n, length, weight, mobility, added, inverse_pivot, change};
  return {n, weight, change, coupling};
}

/// The displacement of a particle on a tether, as a factor of (x - anchor).
template <class R>
PLIANT_HD R tether_share(const R& distance, const R& longest) {
  return (longest - distance) / max(distance, R(smallest_denominator));
}

/// Projects the tethers of one particle one after another. `anchors` has a position and a displacement for each anchor.
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
