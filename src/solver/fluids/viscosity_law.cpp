#include "solver/fluids/viscosity_law.h"

#include <algorithm>

#include "math/functions.h"

namespace pliant {

namespace {

constexpr double diagonal = 1.4142135623730951, space_diagonal = 1.7320508075688772;  // of a cube of side 1

/// w of the shells of a cubic lattice of spacing 1, which has 6, 12 and 8 neighbours at 1, sqrt(2) and sqrt(3).
struct Shells {
  double first, second, third;
};

Shells shells(double far) {
  const auto w = [&](double r) { return (2 - r) * ((1 - far) + far * (2 - r)); };
  return {w(1), w(diagonal), w(space_diagonal)};
}

/// A lattice whose pairs are springs is isotropic if its sums of w r^2 n_x^4 are three times those of w r^2 n_x^2
/// n_y^2, which are 2 w_1 + 4 w_2 + 8/3 w_3 and 2 w_2 + 8/3 w_3: w_1 = w_2 + 8/3 w_3.
double isotropic_far() {
  const auto lack = [](double far) {
    const Shells w = shells(far);
    return w.first - w.second - 8. / 3 * w.third;
  };
  return lack(0) / (lack(0) - lack(1));  // linear in far
}

/// Share of the wall's thickness of influence, twice the spacing, at a distance.
double fade(double distance_over_spacing) {
  const double t = 1 - distance_over_spacing / 2;
  return t * t * t;
}

}  // namespace

ViscosityLaw viscosity_law(float spacing) {
  const double s = static_cast<double>(spacing), far = isotropic_far();
  const Shells w = shells(far);
  // Work per volume under the shear v = gamma y e_x: mu gamma^2 = sum over neighbours of k (gamma r n_x n_y)^2 / (2 V).
  const double sum = 2 * w.second + 8. / 3 * w.third;  // of w r^2 n_x^2 n_y^2
  ViscosityLaw law;
  law.reach = 2 * spacing;
  law.near = static_cast<float>((1 - far) * s);
  law.far = static_cast<float>(far);
  law.scale = static_cast<float>(2 / (sum * s));
  law.area = static_cast<float>(s * s / (fade(0.5) + fade(1.5)));
  return law;
}

float grip_of_wall(const ViscosityLaw& law, float distance) {
  const float t = std::max(1 - distance / law.reach, 0.f);
  const float arm = std::max(distance, law.reach / 8);  // a quarter of the spacing
  return law.area * t * t * t / arm;
}

}  // namespace pliant
