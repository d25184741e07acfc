// Flat sheets held at all edges that bend too far, because few edges lie between, sheets that lie on supports and bend
// over many edges in a substep, and sheets whose curvature is lost because they are nearly flat
// (docs/internals/bending.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "inspect/inspect_scene.h"
#include "inspect/problems.h"
#include "matter/advice_settings.h"
#include "model/attachments.h"
#include "model/sheet_bending.h"
#include "model/sheet_choice.h"

namespace pliant {

namespace {

/// Told beyond this; the advice leaves `wanted_of_plates` too much.
constexpr double tolerated_of_plates = 1.1, wanted_of_plates = 0.05;
/// By what share a square plate of n edges bends too far, times n^2: measured with 6 to 24 edges, where vertices have
/// six triangles and where not, with one pinned row (supported) and with two (clamped).
constexpr double excess_of_regular[] = {2, 5}, excess_of_irregular[] = {8, 11};
/// A mesh is irregular if more than this share of its free vertices has not six triangles.
constexpr double share_of_irregular = 0.1;

/// A sheet whose border is held.
struct Plate {
  bool is_one = false;
  bool is_clamped = false, is_irregular = false;
  double edges = 0;  ///< across it
  double edge = 0;   ///< their length [m]
};

bool has_held_border(const Object& object, const std::vector<char>& held) {
  std::map<std::pair<int, int>, int> triangles_at;
  for (const auto& t : object.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[static_cast<std::size_t>(k)], b = t[static_cast<std::size_t>((k + 1) % 3)];
      ++triangles_at[{std::min(a, b), std::max(a, b)}];
    }
  return std::all_of(triangles_at.begin(), triangles_at.end(), [&](const auto& edge) {
    return edge.second != 1 || (held[static_cast<std::size_t>(edge.first.first)] != 0 &&
                                held[static_cast<std::size_t>(edge.first.second)] != 0);
  });
}

double area_of(const Object& object, const std::array<int, 3>& t) {
  const auto at = [&](std::size_t k) { return object.positions[static_cast<std::size_t>(t[k])]; };
  return std::sqrt(static_cast<double>(length_squared(cross(at(1) - at(0), at(2) - at(0))))) / 2;
}

bool is_free_triangle(const std::array<int, 3>& t, const std::vector<char>& held) {
  return std::any_of(t.begin(), t.end(), [&](int i) { return held[static_cast<std::size_t>(i)] == 0; });
}

/// True if so many triangles are free that no such sheet bends too far to be told.
bool is_fine(const Object& object, const std::vector<char>& held) {
  constexpr double told_triangles = 2 * excess_of_irregular[1] / (tolerated_of_plates - 1);
  const auto free = std::count_if(object.triangles.begin(), object.triangles.end(),
                                  [&](const auto& t) { return is_free_triangle(t, held); });
  return static_cast<double>(free) >= told_triangles;
}

Plate plate_of(const Object& object, double gravity) {
  const std::vector<char> held = held_particles(object, gravity);
  Plate plate;
  if (std::count(held.begin(), held.end(), 1) == 0 || is_fine(object, held) || !has_held_border(object, held))
    return plate;
  std::vector<int> triangles_at(held.size(), 0);
  double area = 0, triangles = 0, wholly_held = 0;
  for (const auto& t : object.triangles) {
    const bool is_free = is_free_triangle(t, held);
    for (const int i : t) ++triangles_at[static_cast<std::size_t>(i)];
    area += is_free ? area_of(object, t) : 0;
    triangles += is_free ? 1 : 0;
    wholly_held += is_free ? 0 : 1;
  }
  if (!(triangles > 0)) return plate;
  double free = 0, irregular = 0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i] != 0 || triangles_at[i] == 0) continue;
    ++free;
    irregular += triangles_at[i] == 6 ? 0 : 1;
  }
  plate.is_one = free > 0;
  plate.edges = std::sqrt(triangles / 2);
  plate.edge = std::sqrt(2 * area / triangles);
  plate.is_clamped = wholly_held > 3 * plate.edges;
  plate.is_irregular = irregular > share_of_irregular * free;
  return plate;
}

struct SoftPlate {
  const Object* object = nullptr;
  std::string problem, advice;
};

/// Appends the sheets whose rest shapes are bowed by so little that they are taken as flat.
void find_bowed_sheets(const Scene& scene, const Settings& settings, std::vector<SoftPlate>& found) {
  if (settings.integrator == Settings::Integrator::energy || settings.sweep == Sweep::natural) return;
  const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
  std::vector<int> substeps_of;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (object.triangles.empty() || object.volume || has_long_edges(object, gravity)) continue;
    const double bow = bow_of_sheet(object);
    if (!(bow > 0)) continue;
    if (substeps_of.empty()) substeps_of = chosen_substeps(scene, settings);
    const double h = static_cast<double>(scene.frame_time) / std::max(substeps_of[o], least_substeps_of_sheets);
    if (!bends_as_sheet(object, h)) continue;
    found.push_back({&object,
                     "has a rest shape that is bowed by " + words(std::round(1e6 * bow) / 1e6) +
                         " m, so little that it bends as a flat sheet does: at rest without load it is flat",
                     "bow it by more than a fiftieth of an edge, or take the weight that bows it instead, if that "
                     "counts"});
  }
}

/// True if an object may lie on a collider, on another object or on a body.
bool may_lie_on_something(const Scene& scene, const Object& object) {
  if (!object.collides) return false;
  if (!scene.colliders.empty() || !scene.mesh_colliders.empty()) return true;
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [&](const Object& other) { return &other != &object && other.collides; });
}

/// Appends the sheets that bend over so many edges in a substep that the forces of their supports are not found in full
/// (solver/sheets/sheet_contacts.h).
void find_sheets_on_supports(const Scene& scene, const Settings& settings, std::vector<SoftPlate>& found) {
  constexpr double most_edges = 2.3, wanted_edges = 2.1, most_excess = 1.1;
  if (settings.integrator == Settings::Integrator::energy || settings.sweep == Sweep::natural) return;
  const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
  std::vector<int> substeps_of;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (object.triangles.empty() || object.volume || !may_lie_on_something(scene, object)) continue;
    if (substeps_of.empty()) substeps_of = chosen_substeps(scene, settings);
    const int substeps = std::max(substeps_of[o], least_substeps_of_sheets);
    const double h = static_cast<double>(scene.frame_time) / substeps;
    const double edges = std::sqrt(h * std::sqrt(facts_of_sheet(object).stiffness));
    if (!(edges > most_edges) || has_long_edges(object, gravity) || !bends_as_sheet(object, h)) continue;
    const double needed = std::ceil(substeps * (edges / wanted_edges) * (edges / wanted_edges));
    if (needed > most_substeps_of_frame) continue;
    found.push_back({&object,
                     "bends over " + words(std::round(10 * edges) / 10) +
                         " edges of its mesh in a substep, so it sags up to " + words(most_excess) +
                         " times too far where it lies on supports, and may hum there",
                     "use " + words(needed) + " substeps, or edges " +
                         words(std::ceil(10 * edges / wanted_edges) / 10) + " times as long"});
  }
}

/// How many times as long as high the triangles of a mesh are that one in a hundred exceeds.
double slenderness_of(const Object& object) {
  std::vector<double> all;
  all.reserve(object.triangles.size());
  for (const auto& t : object.triangles) {
    const auto at = [&](std::size_t k) { return object.positions[static_cast<std::size_t>(t[k])]; };
    const double longest = static_cast<double>(
        std::max({length_squared(at(1) - at(0)), length_squared(at(2) - at(1)), length_squared(at(0) - at(2))}));
    all.push_back(longest / std::max(2 * area_of(object, t), 1e-30));
  }
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), place, all.end());
  return *place;
}

/// Appends the sheets for whose slender triangles the cycles of their bending are too few (docs/internals/bending.md).
void find_slender_sheets(const Scene& scene, const Settings& settings, std::vector<SoftPlate>& found) {
  constexpr double most_slender = 10, wanted = 7;
  if (settings.integrator == Settings::Integrator::energy || settings.sweep == Sweep::natural) return;
  const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
  std::vector<int> substeps_of;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (object.triangles.empty() || object.volume || has_long_edges(object, gravity)) continue;
    const double slenderness = slenderness_of(object);
    if (slenderness <= most_slender) continue;
    if (substeps_of.empty()) substeps_of = chosen_substeps(scene, settings);
    const double h = static_cast<double>(scene.frame_time) / std::max(substeps_of[o], least_substeps_of_sheets);
    if (!bends_as_sheet(object, h)) continue;
    found.push_back({&object,
                     "has triangles " + words(std::round(slenderness)) +
                         " times as long as they are high, too slender for the solve of its bending: it may stretch to "
                         "several times its length",
                     "use a mesh whose triangles are at most " + words(wanted) + " times as long as high"});
  }
}

std::vector<SoftPlate> find_soft_plates(const Scene& scene, const Settings& settings) {
  std::vector<SoftPlate> found;
  find_bowed_sheets(scene, settings, found);
  find_sheets_on_supports(scene, settings, found);
  find_slender_sheets(scene, settings, found);
  const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
  std::vector<int> substeps_of;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (object.triangles.empty() || object.volume || has_long_edges(object, gravity)) continue;
    const Plate plate = plate_of(object, gravity);
    if (!plate.is_one) continue;
    if (substeps_of.empty()) substeps_of = chosen_substeps(scene, settings);
    const double h = static_cast<double>(scene.frame_time) / std::max(substeps_of[o], least_substeps_of_sheets);
    if (!bends_as_sheet(object, h)) continue;
    const double excess = (plate.is_irregular ? excess_of_irregular : excess_of_regular)[plate.is_clamped ? 1 : 0];
    const double times = 1 + excess / (plate.edges * plate.edges),
                 needed = std::ceil(std::sqrt(excess / wanted_of_plates));
    if (times <= tolerated_of_plates) continue;
    found.push_back({&object,
                     "is a sheet that is held at all edges, with about " + words(std::round(plate.edges)) +
                         " edges of its mesh across, so it bends about " + words(std::round(10 * times) / 10) +
                         " times as far as its stiffness says",
                     "give it " + words(needed) + " across: edges of " +
                         words(std::round(1e4 * plate.edge * plate.edges / needed) / 1e4) + " m"});
  }
  return found;
}

}  // namespace

std::vector<char> held_particles(const Object& object, double gravity) {
  std::vector<char> held(object.positions.size(), 0);
  const std::vector<int> targets = held_by_targets(object, gravity);
  for (std::size_t i = 0; i < held.size(); ++i) {
    const bool is_attached = !targets.empty() && targets[i] != static_cast<int>(i);
    held[i] = std::isinf(object.masses[i]) || is_attached ? 1 : 0;
  }
  for (const Pin& pin : object.pins) held[static_cast<std::size_t>(pin.particle)] = 1;
  return held;
}

void doubt_plates(Problems& problems, const Scene& scene) {
  for (const SoftPlate& found : find_soft_plates(scene, scene.settings)) {
    problems.at(found.object->name);
    problems.doubtful("", found.problem, found.advice);
  }
  problems.at("");
}

std::vector<std::string> warnings_of_plates(const Scene& scene, const Settings& settings) {
  std::vector<std::string> warnings;
  for (const SoftPlate& found : find_soft_plates(scene, settings))
    warnings.push_back("object '" + found.object->name + "' " + found.problem + "; " + found.advice);
  return warnings;
}

}  // namespace pliant
