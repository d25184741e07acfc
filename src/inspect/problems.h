// Where the checks of a scene put what they find: into a list for people to read, or straight into an Error.
//
// The same checks serve both, so that what `inspect` calls grave and what a World refuses can't differ.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Counts things of one kind that share a problem, so that a thousand of them are one finding.
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

  /// Findings from now on are about this object or collider; empty: about the scene.
  void at(const std::string& object) { object_ = object; }

  /// Throws Error where grave findings are not collected.
  void grave(const std::string& element, const std::string& problem, const std::string& advice);
  void grave(const Tally& tally, const std::string& kind, const std::string& problem, const std::string& advice);
  void doubtful(const std::string& element, const std::string& problem, const std::string& advice);
  void doubtful(const Tally& tally, const std::string& kind, const std::string& problem, const std::string& advice);

  bool wants_doubts() const { return mode_ == Mode::collect; }
  int grave_count() const { return grave_count_; }
  std::vector<Finding> take();  ///< the grave ones first

 private:
  void put(bool grave, const std::string& element, const std::string& problem, const std::string& advice);

  Mode mode_;
  std::string object_;
  std::vector<Finding> findings_;
  int grave_count_ = 0;
};

/// A number as people write it: "0.3", "1e-05".
std::string words(double value);

/// Grave where `value` is not within [low, high]; NaN never is.
void require_range(Problems& problems, const std::string& element, double value, double low, double high);

/// Grave where a coordinate is not finite or larger than any scene needs.
void require_place(Problems& problems, const std::string& element, const Vec3f& place);

bool is_finite(const Vec3f& v);
bool is_place(const Vec3f& v);

/// No coordinate [m] or speed [m/s] may be larger: products of three still fit a float.
constexpr float largest_place = 1e9f;
/// No finite mass [kg] or compliance may be larger; no mass smaller than its inverse.
constexpr float largest_quantity = 1e20f;

void check_stiffness(Problems& problems, const std::string& element, const Stiffness& stiffness);
void check_motion(Problems& problems, const std::string& element, const Motion& motion);
void check_rotation(Problems& problems, const std::string& element, const Quatf& rotation);
void check_friction(Problems& problems, float static_friction, float kinetic_friction, float restitution);

/// Everything about one object that a World would refuse.
void check_object(Problems& problems, const Object& object);
/// What else is worth knowing about an object that nothing is grave in.
void doubt_object(Problems& problems, const Object& object, const Scene& scene);

/// Everything about a mesh collider that a World would refuse.
void check_mesh_collider(Problems& problems, const MeshCollider& collider);
/// Everything about the scene's pairs that a World would refuse.
void check_pairs(Problems& problems, const Scene& scene);
/// Objects whose contact would take memory and time out of all proportion: too thick for their mesh, or too far from the origin. For a
/// scene that nothing is grave in.
void check_contact_cost(Problems& problems, const Scene& scene);
/// The median edge of the surface, or link where there is none; 0 where there are neither [m].
double median_edge(const Object& object);
/// Where things may not pass through one another at the start, that they do, or are shut up in one another: for a scene that
/// nothing is grave in.
void refuse_tangles(Problems& problems, const Scene& scene);
/// Where they may, that they do.
void doubt_tangles(Problems& problems, const Scene& scene);
/// What else is worth knowing about contact among what moves, in a scene that nothing is grave in.
void doubt_contact(Problems& problems, const Scene& scene);

}  // namespace pliant
