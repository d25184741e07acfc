// Where the checks of a scene report: to a list of findings, or as an Error at the first grave one.
//
// `inspect` and World use the same checks, so `inspect` calls grave exactly what a World rejects.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Counts equal findings and keeps the first, so that a thousand of them make one finding.
struct Tally {
  std::int64_t first = -1, count = 0;
  void add(std::int64_t index) {
    if (count++ == 0) first = index;
  }
  /// Names the finding's elements: "particle 12", or "particle 12 and 3 more".
  std::string name(const std::string& kind) const;
};

class Problems {
 public:
  enum class Mode { throw_grave, collect };
  explicit Problems(Mode mode) : mode_(mode) {}

  /// Sets the object or collider to which the following findings belong; empty: the scene.
  void at(const std::string& object) { object_ = object; }

  /// Adds a grave finding, or throws it as an Error if findings are not collected.
  void grave(const std::string& element, const std::string& problem, const std::string& advice);
  void grave(const Tally& tally, const std::string& kind, const std::string& problem, const std::string& advice);
  void doubtful(const std::string& element, const std::string& problem, const std::string& advice);
  void doubtful(const Tally& tally, const std::string& kind, const std::string& problem, const std::string& advice);

  bool wants_doubts() const { return mode_ == Mode::collect; }
  int grave_count() const { return grave_count_; }
  std::vector<Finding> take();  ///< returns all findings, grave ones first

 private:
  void put(bool grave, const std::string& element, const std::string& problem, const std::string& advice);

  Mode mode_;
  std::string object_;
  std::vector<Finding> findings_;
  int grave_count_ = 0;
};

/// Returns a number in short form: "0.3", "1e-05".
std::string words(double value);

/// Reports a grave finding if `value` is outside [low, high] or NaN.
void require_range(Problems& problems, const std::string& element, double value, double low, double high);

/// Reports a grave finding if a coordinate is not finite or beyond largest_place.
void require_place(Problems& problems, const std::string& element, const Vec3f& place);

bool is_place(const Vec3f& v);

/// Largest coordinate [m] and speed [m/s]: products of three such numbers fit a float.
constexpr float largest_place = 1e9f;
/// Largest finite mass [kg] and compliance; masses must exceed its inverse.
constexpr float largest_quantity = 1e20f;

void check_stiffness(Problems& problems, const std::string& element, const Stiffness& stiffness);
void check_motion(Problems& problems, const std::string& element, const Motion& motion);
void check_rotation(Problems& problems, const std::string& element, const Quatf& rotation);
void check_friction(Problems& problems, float static_friction, float kinetic_friction, float restitution);
void check_rolling(Problems& problems, float rolling_friction, float spinning_friction);
void check_surface_velocity(Problems& problems, const std::string& element, const Vec3f& velocity);

/// True if the numbers of a Plasticity are in their range.
bool is_sound(const Plasticity& plasticity);

/// Reports as grave what is wrong with the rigid bodies of an object.
void check_bodies(Problems& problems, const Object& object);
void check_clusters(Problems& problems, const Object& object);
/// Reports as grave what is wrong with how an object tears, is cut, and with its skin.
void check_tears(Problems& problems, const Object& object);
/// Warns of cuts that do nothing, and of skins far from their body.
void doubt_tears(Problems& problems, const Object& object, const Scene& scene);
/// Reports as grave what is wrong with how a surface takes up liquid.
void check_absorbency(Problems& problems, const Object& object);
/// Warns of surfaces that no liquid meets.
void doubt_absorbency(Problems& problems, const Object& object, const Scene& scene);
/// Reports as grave everything for which a World rejects an object.
void check_object(Problems& problems, const Object& object);
/// Reports doubtful settings of an object that has no grave findings.
void doubt_object(Problems& problems, const Object& object, const Scene& scene);
/// Warns of constraints on flat tetrahedra and triangles, and of those without rest data that act.
void doubt_elements(Problems& problems, const Object& object);
/// Warns of rods that carry more than contact can bear in the scene's substeps. The scene must have no grave findings.
void doubt_substeps_of_rods(Problems& problems, const Scene& scene);
/// Warns of volumes whose surface would jump to their pressure at the start. The scene must have no grave findings.
void doubt_jumps_of_volumes(Problems& problems, const Scene& scene);
/// Doubts particles of liquids, gases and grains that start within one another, and emitters that shoot.
void doubt_flows(Problems& problems, const Scene& scene);
/// Says which soft bodies have numbers that are probably in another unit. The scene must have no grave findings.
void doubt_soft_bodies(Problems& problems, const Scene& scene);
/// Says by how much too few substeps soften soft bodies. The scene must have no grave findings.
void doubt_substeps_of_soft_bodies(Problems& problems, const Scene& scene);
/// Says how many times too stiffly slender solids of few cells across will bend. The scene must have no grave findings.
void doubt_bent_solids(Problems& problems, const Scene& scene);
/// Doubts particles of liquids, gases and grains that start inside solids.
void doubt_starts_in_solids(Problems& problems, const Scene& scene);
/// Doubts surfaces, ropes and bodies that start inside of rigid bodies, and what starts wholly inside of a soft body.
/// The scene must have no grave findings.
void doubt_starts_in_bodies(Problems& problems, const Scene& scene);
/// Doubts woven cloth whose triangles yield much more than their stiffness says.
void doubt_substeps_of_woven(Problems& problems, const Scene& scene);
/// Those whose hinges bend further than their stiffness says, because they have too few substeps for their mesh.
void doubt_substeps_of_hinges(Problems& problems, const Scene& scene);
/// Those that hang by multigrid and stretch further than their stiffness says.
void doubt_springs_of_multigrid(Problems& problems, const Scene& scene);
/// Sheets that are held at all edges and bend further than their stiffness says, because few edges lie across.
void doubt_plates(Problems& problems, const Scene& scene);
/// Warns of bodies that a pin moves, but that a load can turn.
void doubt_bodies(Problems& problems, const Object& object);
/// Warns of joints that are probably not as intended.
void doubt_joints(Problems& problems, const Object& object);

/// Reports as grave everything for which a World rejects a mesh collider.
void check_mesh_collider(Problems& problems, const MeshCollider& collider);
/// Reports as grave everything for which a World rejects the scene's pairs.
void check_pairs(Problems& problems, const Scene& scene);
/// Reports as grave objects whose contact needs excessive memory and time: too thick for their mesh, or too far from
/// the origin. The scene must have no grave findings.
void check_contact_cost(Problems& problems, const Scene& scene);
/// The median edge length of an object's surface, or of its links if it has none [m]; 0: neither.
double median_edge(const Object& object);
/// Reports initial intersections and enclosures as grave if the settings refuse them. The scene must have no grave
/// findings.
void refuse_tangles(Problems& problems, const Scene& scene);
/// Warns of initial intersections and enclosures if the settings allow them.
void doubt_tangles(Problems& problems, const Scene& scene);
/// Warns about contact between dynamic objects. The scene must have no grave findings.
void doubt_contact(Problems& problems, const Scene& scene);

}  // namespace pliant
