// Hanging objects that the sweep multigrid stretches further than their stiffness says, since it treats stiff springs
// as softer than they are (docs/internals/multigrid.md).
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "constraints/registry.h"
#include "inspect/inspect_scene.h"
#include "inspect/problems.h"
#include "matter/advice_settings.h"
#include "matter/object_facts.h"
#include "model/attachments.h"
#include "model/spring_limit.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// A stretch beyond this, over what the stiffness says, is told; the advice is for `wanted_of_springs` too much.
constexpr double tolerated_of_springs = 1.1, wanted_of_springs = 0.05;
/// The excess of plain sweeps times the square of the substeps, over dt^2 K / m; that of chains on irregular meshes.
constexpr double excess_of_sweeps = 0.5, excess_of_chains = 0.25;
/// The mean strain of hanging irregular cloth at the limit, measured (docs/internals/multigrid.md).
constexpr double strain_at_limit = 0.00042;

/// The springs of an object with compliance.
struct SpringFacts {
  std::vector<double> stiffness;  ///< 1 / compliance [N/m]
  double length = 0;              ///< mean [m]
};

SpringFacts facts_of_springs(const Object& object) {
  SpringFacts facts;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_length(group.type) || group.stiffness.kind != Stiffness::Kind::compliance) continue;
    for (std::size_t i = 0; i < group.particles.size() / 2; ++i) {
      const double alpha =
          static_cast<double>(i < group.compliances.size() ? group.compliances[i] : group.stiffness.value);
      if (!(alpha > 0)) continue;
      const auto place = [&](std::size_t end) {
        return object.positions[static_cast<std::size_t>(group.particles[2 * i + end])];
      };
      facts.stiffness.push_back(1 / alpha);
      facts.length += std::sqrt(static_cast<double>(length_squared(place(1) - place(0))));
    }
  }
  facts.length /= std::max<double>(1, static_cast<double>(facts.stiffness.size()));
  return facts;
}

/// How far springs stretch under the object's weight.
struct SpringStretch {
  double times = 1;   ///< over what their stiffness says
  double strain = 0;  ///< too much, in the mean
  double needed = 0;  ///< substeps of chains with which it is wanted_of_springs too much
};

SpringStretch stretch_of_springs(const Object& object, const Scene& scene, double substeps) {
  const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
  const SpringFacts springs = facts_of_springs(object);
  const double mass = finite_mass(object),
               limit = spring_limit({mass, largest_extent(object.positions), springs.length},
                                    static_cast<double>(object.positions.size()), gravity);
  double capped = 0, whole = 0;
  for (const double stiffness : springs.stiffness) {
    capped += std::min(stiffness, limit);
    whole += stiffness;
  }
  if (!(whole > capped)) return {};
  const double count = static_cast<double>(springs.stiffness.size()), of_limit = whole / capped - 1;
  const double per_mass = whole / count * static_cast<double>(object.positions.size()) / mass;
  const double rate = static_cast<double>(scene.frame_time) * static_cast<double>(scene.frame_time) * per_mass;
  const double excess = 1 / (1 / of_limit + substeps * substeps / (excess_of_sweeps * rate));
  return {1 + excess, excess * strain_at_limit * limit * count / whole,
          std::sqrt(excess_of_chains * rate / wanted_of_springs)};
}

std::string advice_of_springs(double needed) {
  if (needed > most_substeps_of_frame)
    return "no sweep has substeps enough for such stiff springs: make them softer, or the edges longer";
  return "use the sweep \"chains\" with " + std::to_string(std::llround(std::ceil(needed))) +
         " substeps where that counts";
}

bool has_free_particles(const Object& object, double gravity) {
  const std::vector<char> held = held_particles(object, gravity);
  return std::find(held.begin(), held.end(), 0) != held.end();
}

struct SoftSprings {
  const Object* object = nullptr;
  std::string problem, advice;
};

std::vector<SoftSprings> find_soft_springs(const Scene& scene, const Settings& settings) {
  std::vector<SoftSprings> found;
  const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
  if (!(gravity > 0)) return found;
  const std::vector<Sweep> sweeps = chosen_sweeps(scene, settings);
  std::vector<int> substeps_of;  // empty until an object needs it
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (sweeps[o] != Sweep::multigrid || !has_fixed(object) || !has_free_particles(object, gravity)) continue;
    if (substeps_of.empty()) substeps_of = chosen_substeps(scene, settings);
    const int substeps = substeps_of[o] > 0 ? substeps_of[o] : std::max(least_by_state, settings.least_substeps);
    const SpringStretch stretch =
        stretch_of_springs(object, scene, static_cast<double>(substeps) * settings.iterations);
    if (stretch.times <= tolerated_of_springs) continue;
    found.push_back({&object,
                     "is solved by multigrid, by which it stretches about " +
                         words(std::round(10 * stretch.times) / 10) +
                         " times as far under its weight as its stiffness says, " +
                         words(std::round(1e4 * stretch.strain) / 100) + " % of strain too much",
                     advice_of_springs(stretch.needed)});
  }
  return found;
}

}  // namespace

void doubt_springs_of_multigrid(Problems& problems, const Scene& scene) {
  for (const SoftSprings& found : find_soft_springs(scene, scene.settings)) {
    problems.at(found.object->name);
    problems.doubtful("", found.problem, found.advice);
  }
  problems.at("");
}

std::vector<std::string> warnings_of_multigrid(const Scene& scene, const Settings& settings) {
  std::vector<std::string> warnings;
  for (const SoftSprings& found : find_soft_springs(scene, settings))
    warnings.push_back("object '" + found.object->name + "' " + found.problem + "; " + found.advice);
  return warnings;
}

}  // namespace pliant
