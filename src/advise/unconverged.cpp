// What a run shows to be far from converged, in words.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pliant/advise.h"
#include "world/advice.h"

namespace pliant {

namespace {

/// The error that the advised substeps leave, as ConvergenceEstimate::excess: of bending and shear, of volumes, and of
/// joints.
constexpr double wanted_of_yield = 0.05, wanted_of_volume = 0.025, wanted_of_joints = 0.005;

bool is_yield(Resistance kind) { return kind == Resistance::bending || kind == Resistance::shear; }

/// What is wrong, after the object's name.
std::string words_of(Resistance kind, const ConvergenceEstimate& estimate) {
  const std::string share = percent(estimate.excess);
  if (kind == Resistance::joints) return "has joints open by " + share + " of the size of their bodies";
  if (kind == Resistance::volume) return "has tetrahedra whose volumes are off by " + share;
  if (kind == Resistance::stretching) return "stretches " + share + " further than its stiffness says";
  return "yields about " + share + " more in " + name_of(kind) + " than its stiffness says";
}

/// The substeps that are likely to do: the error falls as their square.
int wanted_substeps(Resistance kind, const ConvergenceEstimate& estimate) {
  constexpr double most = 10000;
  const double wanted = is_yield(kind)                   ? wanted_of_yield
                        : kind == Resistance::stretching ? tolerated_p99 / 2
                        : kind == Resistance::volume     ? wanted_of_volume
                                                         : wanted_of_joints;
  return static_cast<int>(
      std::ceil(std::min(most, std::max(1, estimate.substeps) * std::sqrt(estimate.excess / wanted))));
}

bool has(const std::string& line, const std::string& words) { return line.find(words) != std::string::npos; }

/// True if a line says of an object how far it yields, or of any how far it is stretched.
bool says(const std::string& line, Resistance kind, const std::string& name) {
  if (kind == Resistance::stretching && has(line, "stretched")) return true;
  return has(line, "'" + name + "'") && (has(line, "stiffness says") || has(line, "modulus says"));
}

}  // namespace

std::vector<std::string> unconverged(const World& world, const WorstEstimates& worst,
                                     const std::vector<std::string>& said) {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < resistance_count; ++k) {
    const auto kind = static_cast<Resistance>(k);
    const ConvergenceEstimate& found = worst.estimates[k];
    if (kind == Resistance::density || worst.frames[k] == 0 || is_tolerable(kind, found)) continue;
    const std::vector<ObjectId> objects = world.objects();
    if (std::find(objects.begin(), objects.end(), found.object) == objects.end()) continue;
    const std::string name = world.object(found.object).info().name;
    const auto is_said = [&](const std::string& line) { return says(line, kind, name); };
    if (std::any_of(said.begin(), said.end(), is_said)) continue;
    lines.push_back("in frame " + std::to_string(worst.frames[k]) + ", object '" + name + "' " + words_of(kind, found) +
                    ", with " + std::to_string(found.substeps) +
                    " substeps; \"substeps\": " + std::to_string(wanted_substeps(kind, found)) + " should mend it");
  }
  return lines;
}

}  // namespace pliant
