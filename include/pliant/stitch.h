// Sewing and welding: what brings particles of an object together, and makes one of them.
//
//   const std::vector<std::array<int, 2>> seam = nearest_pairs(shirt, left_of_front, left_of_back);
//   add_stitches(shirt, seam, {.closing_time = 1});                  // threads that become shorter
//   ...
//   world.edit(id, weld(shirt, seam));                               // and at last one particle for each pair
#pragma once

#include <array>
#include <span>
#include <vector>

#include "pliant/edit.h"
#include "pliant/scene.h"

namespace pliant {

/// Options of add_stitches.
struct StitchOptions {
  /// Until when the threads have shortened from the distance at the start to nothing; 0: at once [s]
  float closing_time = 0;
  Stiffness stiffness{};  ///< of the threads
  float break_force = 0;  ///< ConstraintGroup::break_force; 0: they hold [N]
};

/// For each of `particles` the nearest of `others` in the rest shape, which is not itself; of equally near ones that
/// with the lowest index. Throws an Error if a particle does not exist, or `others` has none but itself.
std::vector<std::array<int, 2>> nearest_pairs(const Object& object, std::span<const int> particles,
                                              std::span<const int> others);

/// Adds a thread between the particles of each pair: a "distance_limit" that pulls when it is taut, and never pushes.
/// Throws an Error if a particle does not exist, a pair has one particle twice, or the time is negative.
void add_stitches(Object& object, std::span<const std::array<int, 2>> pairs, const StitchOptions& options = {});

/// The Edit that makes one particle of those of each pair, and of all that pairs link. It has the mass of all, and
/// place and velocity of a pinned one, or else the heaviest: so weld what is together already, or momentum changes.
/// Constraints keep their rest data; those that lose a particle, as stitches do, are left out, and so are triangles
/// that meet inside a soft body. A seam bends freely, and plastic flow beside it is lost. Object::positions are those
/// of one side, by which later tears of soft bodies are judged. Throws an Error if a particle does not exist, a
/// triangle has two particles of a pair, or the object has bodies or Absorbency, or is a liquid, gas or grains.
Edit weld(const Object& object, std::span<const std::array<int, 2>> pairs);

}  // namespace pliant
