// The sink of a scene's checks: a list of findings to read, or an immediate Error.
//
// `inspect` and World use the same checks, so `inspect` calls grave exactly what a World rejects.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Merges equal findings: counts them and keeps the first, so that a thousand of them are one finding.
struct Tally {
  std::int64_t first = -1, count = 0;
  void add(std::int64_t index) {
    if (count++ == 0) first = index;
  }
  /// "particle 12", or "particle 12 and 3 more".
  std::string name(const std::string& kind) const;
};

class Problems {
 public:
  enum class Mode { throw_grave, collect };
  explicit Problems(Mode mode) : mode_(mode) {}

  /// Sets the object or collider of the findings that follow; empty: the scene.
  void at(const std::string& object) { object_ = object; }

  /// Throws an Error instead if findings are not collected.
  void grave(const std::string& element, const std::string& problem, const std::string& advice);
  void grave(const Tally& tally, const std::string& kind, const std::string& problem, const std::string& advice);
  void doubtful(const std::string& element, const std::string& problem, const std::string& advice);
  void doubtful(const Tally& tally, const std::string& kind, const std::string& problem, const std::string& advice);

  bool wants_doubts() const { return mode_ == Mode::collect; }
  int grave_count() const { return grave_count_; }
  std::vector<Finding> take();  ///< grave findings first

 private:
  void put(bool grave, const std::string& element, const std::string& problem, const std::string& advice);

  Mode mode_;
  std::string object_;
  std::vector<Finding> findings_;
  int grave_count_ = 0;
};

/// A number in short form: "0.3", "1e-05".
std::string words(double value);

/// Reports a grave finding if `value` is outside [low, high] or NaN.
void require_range(Problems& problems, const std::string& element, double value, double low, double high);

/// Reports a grave finding if a coordinate is not finite or beyond largest_place.
void require_place(Problems& problems, const std::string& element, const Vec3f& place);

bool is_finite(const Vec3f& v);
bool is_place(const Vec3f& v);

/// Limit of coordinates [m] and speeds [m/s]: products of three still fit a float.
constexpr float largest_place = 1e9f;
/// Limit of finite masses [kg] and compliances; masses must exceed its inverse.
constexpr float largest_quantity = 1e20f;

void check_stiffness(Problems& problems, const std::string& element, const Stiffness& stiffness);
void check_motion(Problems& problems, const std::string& element, const Motion& motion);
void check_rotation(Problems& problems, const std::string& element, const Quatf& rotation);
void check_friction(Problems& problems, float static_friction, float kinetic_friction, float restitution);

/// Checks an object for everything that a World rejects.
void check_object(Problems& problems, const Object& object);
/// Warns about an object without grave findings.
void doubt_object(Problems& problems, const Object& object, const Scene& scene);

/// Checks a mesh collider for everything that a World rejects.
void check_mesh_collider(Problems& problems, const MeshCollider& collider);
/// Checks the scene's pairs for everything that a World rejects.
void check_pairs(Problems& problems, const Scene& scene);
/// Rejects objects whose contact would need excessive memory and time: too thick for their mesh, or too far from the
/// origin. Call it for scenes without grave findings.
void check_contact_cost(Problems& problems, const Scene& scene);
/// The median edge of the surface, else the median link; 0 if there is neither [m].
double median_edge(const Object& object);
/// Rejects initial intersections and enclosures if the scene
/// forbids them. Call it for scenes without grave findings.
void refuse_tangles(Problems& problems, const Scene& scene);
/// Warns of initial intersections and enclosures if the scene permits them.
void doubt_tangles(Problems& problems, const Scene& scene);
/// Warns about contact between dynamic objects in a scene without grave findings.
void doubt_contact(Problems& problems, const Scene& scene);

}  // namespace pliant
