// Errors and doubts in how a surface takes up liquid.
#include <algorithm>
#include <string>

#include "inspect/problems.h"

namespace pliant {

namespace {

bool groups_meet(const Object& a, const Object& b) { return (a.mask & b.groups) != 0 && (b.mask & a.groups) != 0; }

}  // namespace

void check_absorbency(Problems& problems, const Object& object) {
  if (!object.absorbency) return;
  const Absorbency& a = *object.absorbency;
  require_range(problems, "absorbency, capacity", static_cast<double>(a.capacity), 1e-6, 1e6);
  require_range(problems, "absorbency, uptake", static_cast<double>(a.uptake), 0, 1e6);
  require_range(problems, "absorbency, wicking", static_cast<double>(a.wicking), 0, 1e6);
  require_range(problems, "absorbency, rise", static_cast<double>(a.rise), 1e-6, 1e6);
  require_range(problems, "absorbency, runoff", static_cast<double>(a.runoff), 0, 1e6);
  require_range(problems, "absorbency, seepage", static_cast<double>(a.seepage), 0, 1e6);
  require_range(problems, "absorbency, drag", static_cast<double>(a.drag), 0, 1e6);
  if (object.triangles.empty())
    problems.grave("absorbency", "is of an object without triangles, which has no surface to take up liquid",
                   "give it to cloth, or leave it out");
}

void doubt_absorbency(Problems& problems, const Object& object, const Scene& scene) {
  if (!object.absorbency) return;
  const bool is_met = std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& other) {
    return other.fluid && !other.gas && groups_meet(other, object);
  });
  if (!is_met)
    problems.doubtful("absorbency", "has no effect, since no liquid of the scene meets the object",
                      "add a liquid whose groups and mask meet those of the object");
  if (!object.collides)
    problems.doubtful("absorbency", "is of an object that liquids pass through, since it does not collide",
                      "set `collides` of the object");
}

}  // namespace pliant
