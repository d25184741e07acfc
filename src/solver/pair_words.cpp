// Warnings about contact between two objects, as pair_words.h declares them.
#include "solver/pair_words.h"

#include <algorithm>
#include <map>
#include <utility>

namespace pliant {

namespace {

/// The user's index of a State particle within its object, as text.
std::string number_of(const Model& model, int particle) {
  const int object = model.object_of(particle);
  return std::to_string(model.objects[object].order[particle - model.first[object]]);
}

std::string name_of(const Model& model, int object) {
  const CompiledObject& of = model.objects[object];
  return (of.is_collider ? "collider '" : "object '") + of.name + "'";
}

/// The number and the first of the intersections between two objects.
struct Between {
  const Intersection* first = nullptr;
  std::int64_t count = 0, given_up = 0;
  bool stalls = false;
};

std::string words_of(const Model& model, const Triangle& triangle, const Between& between) {
  const Intersection& found = *between.first;
  const std::int64_t count = between.count;
  const int a = model.object_of(found.a), b = model.object_of(triangle[0]);
  const std::string corners =
      number_of(model, triangle[0]) + ", " + number_of(model, triangle[1]) + ", " + number_of(model, triangle[2]);
  std::string text = name_of(model, a) + ": edge " + number_of(model, found.a) + "-" + number_of(model, found.b) +
                     " passes through triangle (" + corners + ") of " + (a == b ? "the same" : name_of(model, b));
  if (count > 1) text += " and " + std::to_string(count - 1) + " more";
  text += ": they have intersected since the start or a tear, and have no contact until they are apart";
  if (between.stalls) text += "; untangling did not reduce their number in the previous frame";
  if (between.given_up > 0)
    text += "; " + std::to_string(between.given_up) +
            " of them are not moved apart in this frame, because they cut no piece off or moving would cause more";
  return text + (between.stalls || between.given_up > 0 ? ": move the two apart in the scene" : "");
}

/// Describes a pair with the user's indices: "vertex 4 and triangle (1, 2, 3)".
std::string words_of(const Model& model, const PairStencil& pair) {
  const auto number = [&](int corner) { return number_of(model, pair.vertex[static_cast<std::size_t>(corner)]); };
  if (pair.first_side == 1)
    return "vertex " + number(0) + " and triangle (" + number(1) + ", " + number(2) + ", " + number(3) + ")";
  return "edges " + number(0) + "-" + number(1) + " and " + number(2) + "-" + number(3);
}

std::string words_of(const Model& model, const UnresolvablePairs& pairs) {
  const int a = model.object_of(pairs.first.vertex[0]), b = model.object_of(pairs.first.vertex[3]);
  const std::string of = a == b ? " and itself: " : " and " + name_of(model, b) + ": ";
  return name_of(model, a) + of + words_of(model, pairs.first) +
         (pairs.count > 1 ? " and " + std::to_string(pairs.count - 1) + " more pairs were" : " were") +
         " unresolvable in this frame: no step limit keeps them apart, because they touched, or pins or colliders "
         "pinched "
         "them, so "
         "they may pass through one another; give them more room, a greater thickness, or more substeps";
}

}  // namespace

void warn_of_pairs(const Model& model, const SurfaceContact& pairs, std::vector<std::string>& warnings) {
  std::map<std::pair<int, int>, Between> between;
  for (const Intersection& found : pairs.intersecting()) {
    const int a = model.object_of(found.a), b = model.object_of(pairs.triangle(found.triangle)[0]);
    Between& of = between[std::minmax(a, b)];
    if (of.count++ == 0) of.first = &found;
    of.given_up += pairs.gives_up(found) ? 1 : 0;
    of.stalls = pairs.stalls(std::minmax(a, b));
  }
  for (const auto& [objects, of] : between) warnings.push_back(words_of(model, pairs.triangle(of.first->triangle), of));
  for (const int body : pairs.too_far())
    warnings.push_back(name_of(model, body) +
                       " is so far from the origin that the rounding of positions is as large as its edges: it has no "
                       "contact there; move the scene to the origin");
  for (const auto& [objects, found] : pairs.unresolvable()) warnings.push_back(words_of(model, found));
}

}  // namespace pliant
