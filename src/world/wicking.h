// How liquid spreads along a surface that takes it up (Absorbency).
#pragma once

#include <vector>

#include "model/compiled_absorbency.h"
#include "parallel/executor.h"

namespace pliant {

/// Where a surface lets liquid run: heights against gravity, and for each particle the edge that leads down most
/// steeply.
struct Slopes {
  std::vector<double> heights;  ///< as high as under the gravity of the Earth [m]
  std::vector<int> down;        ///< the particle at the lower end of that edge; -1: none leads down
  std::vector<double> shares;   ///< of the excess that runs down in a second, over Absorbency::runoff [1/m]
};

/// Heights give the slopes.
Slopes slopes_of(const CompiledAbsorbency& surface, std::vector<double> heights);

/// Lets liquid spread for `seconds`. `water`: of each particle [kg]. Its sum stays, to rounding.
///
/// Along an edge, liquid flows down the potential min(s, capacity) + capacity y / rise of s kg/m^2 at the height y,
/// with a mobility that is proportional to s: as water in porous ground by the equations of Boussinesq (1904) and
/// Richards (1931), so that there is a front. At rest it holds capacity (1 - y / rise) above a bath. What is more than
/// the capacity runs down the steepest edges. carry(from, to, mass) is called after each move of a mass [kg] between
/// particles, for what it takes along.
void spread(const CompiledAbsorbency& surface, const Slopes& slopes, double seconds, float* water,
            FunctionRef<void(int from, int to, float mass)> carry);

}  // namespace pliant
