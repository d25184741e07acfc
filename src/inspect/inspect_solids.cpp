// Particles of liquids, gases and grains that start inside solids, whose contact throws them out.
#include <algorithm>
#include <string>
#include <vector>

#include "inspect/inspect_scene.h"
#include "inspect/problems.h"
#include "matter/leave_out.h"

namespace pliant {

namespace {

/// A particle starts inside if its centre is nearer to a solid than this share of its radius, or in it.
constexpr float inside_share = 0.5f;

struct StartsInside {
  const Object* object = nullptr;
  int particles = 0;
  std::string words;  ///< "particles start inside 'rock' and 1 more"
};

std::vector<StartsInside> find_starts_inside(const Scene& scene, MeshesToo meshes) {
  std::vector<StartsInside> all;
  for (const Object& object : scene.objects) {
    if (!(object.fluid || object.grains) || !(object.thickness > 0)) continue;
    const std::size_t spare =
        std::min(static_cast<std::size_t>(std::max(object.flow.spare, 0)), object.positions.size());
    const std::vector<Vec3f> places(object.positions.begin(),
                                    object.positions.end() - static_cast<std::ptrdiff_t>(spare));
    const std::vector<PlacesInSolid> in = find_in_solids(
        places, scene, {inside_share * object.thickness, object.groups, object.mask, object.collides}, meshes);
    if (in.empty()) continue;
    StartsInside& found = all.emplace_back();
    found.object = &object;
    for (const PlacesInSolid& one : in) found.particles += one.places;
    found.words = std::string(found.particles == 1 ? "particle starts" : "particles start") + " inside '" +
                  in.front().in + "'" + (in.size() > 1 ? " and " + std::to_string(in.size() - 1) + " more" : "");
  }
  return all;
}

constexpr const char* what_to_do = "contact throws them out: place them outside, or let a fill leave out solids";

}  // namespace

void doubt_starts_in_solids(Problems& problems, const Scene& scene) {
  for (const StartsInside& found : find_starts_inside(scene, MeshesToo::yes)) {
    problems.at(found.object->name);
    problems.doubtful("", std::to_string(found.particles) + " " + found.words, what_to_do);
  }
  problems.at("");
}

std::vector<std::string> warnings_of_starts_in_solids(const Scene& scene) {
  std::vector<std::string> warnings;
  for (const StartsInside& found : find_starts_inside(scene, MeshesToo::no))
    warnings.push_back("object '" + found.object->name + "': " + std::to_string(found.particles) + " " + found.words +
                       "; " + what_to_do);
  return warnings;
}

}  // namespace pliant
