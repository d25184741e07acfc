// Measurements of the State of a World, and what to do where the solve falls short.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pliant/report.h"

namespace pliant {

struct WorldData;

/// How the tetrahedra of soft bodies are deformed.
struct TetrahedraMeasure {
  std::int64_t tetrahedra = 0;  ///< with a rest volume, in all objects
  std::int64_t inverted = 0;    ///< of them turned inside out: their volume has another sign than at rest
  double least_ratio = 1;       ///< smallest volume over that at rest; negative for an inverted one [-]
  double volume_ratio = 1;      ///< volume of all over that at rest [-]
  ObjectId object;              ///< the object of the smallest
  std::array<int, 4> particles{
      {-1, -1, -1, -1}};  ///< its corners, in the object's own order; -1: there is no tetrahedron
};

/// Measures a World between steps. A small value that is valid as long as a handle (handles.h).
class Measurements {
 public:
  explicit Measurements(const WorldData& world) : world_(&world) {}

  /// Kinetic and gravitational energy of all dynamic particles [J]. Heights are relative to the origin.
  double kinetic_energy() const;
  double potential_energy() const;
  std::vector<Residual> residuals() const;  ///< with the forces of the last substep; without, as overstretch()
  Stretch stretch() const;
  /// The overstretch of the present State. Before the first step, after World::restore and after a frame that was not
  /// completed, the forces in compliant constraints are unknown, so their whole stretch counts.
  Overstretch overstretch() const;
  TetrahedraMeasure tetrahedra() const;

  /// Describes it: "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more". Of
  /// an object that was removed, or edited so that it lacks these particles, only the figures.
  std::string describe(const Overstretch& found) const;
  /// Says where the solve fell short, by how much, and what to do; empty if is_tolerable(found). `found` is that of a
  /// frame of this World, or the worst of all. pliant::advise tries remedies.
  std::string advice(const Overstretch& found) const;
  /// The same for the frame of a Report; empty if that was not completed.
  std::string advice(const Report& report) const;

 private:
  const WorldData* world_;
};

}  // namespace pliant
