// The energy of a substep's corrections, and the share of them that may become velocity.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Gravity of the frame that the velocities of an object's particles lack.
struct PredictedGravity {
  PredictedGravity(const Substep& s, int object);

  Vec3d acceleration{};      ///< [m/s^2]
  Vec3d settled{}, begun{};  ///< before and after the prediction [m/s]
};

/// Adds the energies of particle `i` of `particles`.
void add_correction_energy(const Substep& s, const PredictedGravity& gravity, const AdvanceArguments& particles, int i,
                           CorrectionEnergy& sum);

/// The energies of a tile's particles at the substep's end, as a polynomial of the share.
CorrectionEnergy correction_energy(const Substep& s, int task);

void add(const CorrectionEnergy& of, CorrectionEnergy& sum);

/// The largest share in [0, 1] with which energy does not increase; if there is none, the share with which it increases
/// least.
double largest_share(const CorrectionEnergy& e);

}  // namespace pliant
