// Finds triangles of cloth and solids of bodies that a substep would make pass one another.
//
// A triangle and a convex solid that are apart at the substep's start have a plane between them. If they are apart at
// its end too, and moved by less than the solid's size, nothing has passed. Else each vertex of the triangle that ends
// on the solid's side of the plane gets a contact along the plane's normal, which takes back as much of the approach as
// is needed, and no more. So it adds no energy. The gap may shrink to `least_gap`, and no further; where it was smaller
// at the start it stays.
//
// Whether a pair passes depends on positions at the substep's start and its end alone. Kept bounds and planes only tell
// where this need not be computed.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "collision/narrow/contact.h"
#include "geometry/convex_shape.h"
#include "solver/bodies/surface_tiles.h"

namespace pliant {

struct Substep;

class PassingFilter {
 public:
  PassingFilter() = default;
  explicit PassingFilter(const std::vector<ConvexShape>& shapes);

  /// Starts a frame: forgets what is kept, because a State does not have it.
  void begin_frame();
  /// What has moved since the last find of a substep. Of other triangles and solids the answer is the same, and is
  /// none.
  struct Moved {
    const std::vector<char>* solids = nullptr;    ///< [solid] null: all
    const std::vector<char>* vertices = nullptr;  ///< [particle of the State]
    float farthest = 0;                           ///< largest displacement of these vertices [m]
  };
  /// Appends contacts for vertices that end beyond a plane, by solid, then by triangle. `solids` are where the
  /// displacements put them; `meets` tells which triangles a solid may touch.
  void find(const Substep& s, SurfaceTiles& surfaces, const std::vector<MovingCollider>& solids, const Moved& moved,
            FunctionRef<bool(const Contact&)> meets, std::vector<Contact>& found);
  /// After the last find of a substep. `is_final`: nothing has moved since.
  void end_substep(bool is_final);

  /// After that: triangles, solids, or both, have been moved on by at most so far [m].
  void note_shift(float farthest);

  /// A triangle and a solid that overlap at the end of the last substep, or passed one another in it.
  struct Overlap {
    int object = 0, vertex = 0;  ///< of the triangle; its first vertex in the State
    int solid = 0;
  };
  /// By solid, after end_substep.
  std::vector<Overlap> overlaps() const;

 private:
  struct Pair {
    std::array<int, 3> element{};
    int object = 0;
    float thickness = 0;        ///< that contact keeps [m]
    float bound = 0, next = 0;  ///< lower bounds of the distance at the substep's start and end [m]
    Vec3f normal{};             ///< from the solid to the triangle, in the solid's frame; 0: not known
    bool overlaps = false;      ///< at the substep's end, by more than the contact yields
  };
  /// How a solid moves in a substep.
  struct Motion {
    Posed before, after;
    Vec3f displacement{};
    float turned = 0;  ///< largest displacement of a point of the solid by its rotation [m]
  };
  struct Solid {
    ConvexShape shape;
    float inner = 0, outer = 0;     ///< radii about the origin of a ball inside the shape and of one around it [m]
    std::vector<Pair> pairs;        ///< by element
    std::vector<int> vertices;      ///< of pairs, ascending
    std::vector<int> close;         ///< indices of the pairs that each find checks, ascending; the others are far
    float slack = 0;                ///< motion that far pairs allow before one has to be checked [m]
    float used = 0, next_used = 0;  ///< of it at the substep's start and end; far pairs' own bounds do not have it [m]
    float fastest = 0;              ///< motion of the fastest pair when all were checked last [m]
    bool is_grouped = false;        ///< close and slack are for the present pairs
    float reach = -1,
          spent = 0;  ///< motion for which pairs are complete; motion since they were found, with the last find [m]
    float next = 0;   ///< motion of the substep [m]
    Motion motion{};  ///< as of the last find that concerns the solid, like the next three
    bool is_concerned = false, is_all = false;  ///< pairs may have to be checked: at all, and all of them
    bool is_new = false;                        ///< pairs are found first
    std::vector<std::int32_t> points;
    std::vector<Contact> found;
    Polyhedron corners;  ///< of one triangle
  };
  static Motion motion_of(const MovingCollider& at, float radius);
  static void forget(Solid& solid);
  static void take_motion(Solid& solid);
  static void find_pairs(const Substep& s, const SurfaceTiles& surfaces, const MovingCollider& at, int number,
                         const FunctionRef<bool(const Contact&)>& meets, Solid& solid);
  static void group_pairs(Solid& solid);
  static bool far_pairs_stay_clear(const Substep& s, Solid& solid);
  static void check(const Substep& s, int number, Solid& solid, Pair& pair);
  static void add_contacts(const Substep& s, int number, const Pair& pair, const Vec3d& normal, double least,
                           std::vector<Contact>& found);
  static void begin_find(const SurfaceTiles& surfaces, const MovingCollider& at, int number, const Moved& moved,
                         Solid& solid);
  static void find_of(const Substep& s, const SurfaceTiles& surfaces, const MovingCollider& at, int number,
                      const Moved& moved, const FunctionRef<bool(const Contact&)>& meets, Solid& solid);
  void sort_points(const Substep& s, SurfaceTiles& surfaces);

  std::vector<Solid> solids_;
  std::vector<int> tiles_;  ///< scratch memory
};

}  // namespace pliant
