// See pair_words.h.
#include "solver/pair_words.h"

#include <algorithm>
#include <map>
#include <utility>

namespace pliant {

namespace {

int object_of(const Model& model, int particle) {
  const auto after = std::upper_bound(model.first.begin(), model.first.end(), particle);
  return static_cast<int>(after - model.first.begin()) - 1;
}

/// A particle of the State in the numbers of its object.
std::string number_of(const Model& model, int particle) {
  const int object = object_of(model, particle);
  return std::to_string(model.objects[object].order[particle - model.first[object]]);
}

std::string name_of(const Model& model, int object) {
  const CompiledObject& of = model.objects[object];
  return (of.is_collider ? "collider '" : "object '") + of.name + "'";
}

std::string words_of(const Model& model, const Triangle& triangle, const Intersection& found, std::int64_t count) {
  const int a = object_of(model, found.a), b = object_of(model, triangle[0]);
  const std::string corners =
      number_of(model, triangle[0]) + ", " + number_of(model, triangle[1]) + ", " + number_of(model, triangle[2]);
  std::string text = name_of(model, a) + ": edge " + number_of(model, found.a) + "-" + number_of(model, found.b) +
                     " passes through triangle (" + corners + ") of " + (a == b ? "the same" : name_of(model, b));
  if (count > 1) text += " and " + std::to_string(count - 1) + " more";
  return text + ": tangled, and left out of contact until they are apart";
}

}  // namespace

void warn_of_pairs(const Model& model, const PairSystem& pairs, std::vector<std::string>& warnings) {
  std::map<std::pair<int, int>, std::pair<const Intersection*, std::int64_t>> between;
  for (const Intersection& found : pairs.tangles()) {
    const int a = object_of(model, found.a), b = object_of(model, pairs.triangle(found.triangle)[0]);
    auto& [first, count] = between[std::minmax(a, b)];
    if (count++ == 0) first = &found;
  }
  for (const auto& [objects, found] : between)
    warnings.push_back(words_of(model, pairs.triangle(found.first->triangle), *found.first, found.second));
  if (const std::int64_t hopeless = pairs.counts().hopeless; hopeless > 0)
    warnings.push_back(std::to_string(hopeless) + (hopeless == 1 ? " pair was hopeless: " : " pairs were hopeless: ") +
                       "they touched, or were pinched by what nothing pushes, and may pass through one another");
}

}  // namespace pliant
