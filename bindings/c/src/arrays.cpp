// Copies the caller's arrays.
#include "arrays.h"

#include <limits>

#include "memory.h"

namespace pliant::c {

namespace {

/// One of a list of arrays, each of which has the size that the first one says.
const pliant_array& array_at(const pliant_array* arrays, size_t index) {
  const size_t size = arrays->size;
  return *reinterpret_cast<const pliant_array*>(reinterpret_cast<const char*>(arrays) + index * size);
}

/// Throws a StatusError if there are more points or elements than indices reach, as where a size is uninitialised.
void require_count(size_t count, const char* what, const std::string& name) {
  constexpr size_t most = std::numeric_limits<std::int32_t>::max();
  if (count > most)
    throw StatusError(PLIANT_REFUSED, "the array '" + name + "' has the " + what + " " + std::to_string(count),
                      "give at most " + std::to_string(most));
}

template <size_t corners>
std::vector<std::array<int, corners>> elements_of(const pliant_array& array) {
  std::vector<std::array<int, corners>> elements(array.element_count);
  const std::int32_t* from = integers(array.elements, array.element_count, "elements").data();
  for (std::array<int, corners>& element : elements)
    for (int& corner : element) corner = *from++;
  return elements;
}

bool is_taken(const SceneArrays& in, const std::string& name) {
  return in.meshes.count(name) + in.tetrahedra.count(name) + in.points.count(name) > 0;
}

[[noreturn]] void refuse_name(const std::string& name) {
  throw StatusError(PLIANT_REFUSED, "the name of the array '" + name + "' is taken by another one",
                    "give each array of a scene its own name");
}

/// Adds one array to those of the scene format.
void add_array(const pliant_array& array, SceneArrays& to) {
  require(array.name, "name");
  if (is_taken(to, array.name)) refuse_name(array.name);
  require_count(array.position_count, "position_count", array.name);
  require_count(array.element_count, "element_count", array.name);
  const std::span<const Vec3f> given = points(array.positions, array.position_count, "positions");
  std::vector<Vec3f> positions(given.begin(), given.end());
  if (array.corners == 3)
    to.meshes[array.name] = {std::move(positions), elements_of<3>(array)};
  else if (array.corners == 4)
    to.tetrahedra[array.name] = {std::move(positions), elements_of<4>(array)};
  else if (array.corners == 0)
    to.points[array.name] = std::move(positions);
  else
    throw StatusError(
        PLIANT_REFUSED,
        "the array '" + std::string(array.name) + "' has elements of " + std::to_string(array.corners) + " corners",
        "give 3 for triangles, 4 for tetrahedra, 0 for points");
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.positions == b.positions && a.triangles == b.triangles;
}
bool same(const TetrahedralMesh& a, const TetrahedralMesh& b) {
  return a.positions == b.positions && a.tetrahedra == b.tetrahedra;
}
bool same(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) { return a == b; }

/// The names of arrays that are not there yet. Throws a StatusError if one is taken by another array.
template <class Map>
void add_new_names(const SceneArrays& to, const Map& there, const Map& from, std::vector<std::string>& names) {
  for (const auto& [name, array] : from) {
    if (!is_taken(to, name)) {
      names.push_back(name);
      continue;
    }
    const auto found = there.find(name);
    if (found == there.end() || !same(found->second, array)) refuse_name(name);
  }
}

}  // namespace

SceneArrays arrays_of(const pliant_array* arrays, size_t count) {
  SceneArrays made;
  if (count == 0) return made;
  require(arrays, "arrays");
  require_size(arrays->size, sizeof(pliant_array), "arrays");
  if (arrays->size % alignof(pliant_array) != 0)
    throw StatusError(
        PLIANT_REFUSED,
        "'arrays' has the size " + std::to_string(arrays->size) + ", which is no multiple of its alignment",
        "set its member `size` to sizeof the structure");
  for (size_t i = 0; i < count; ++i) add_array(array_at(arrays, i), made);
  return made;
}

std::vector<std::string> add_arrays(SceneArrays& to, SceneArrays&& from) {
  std::vector<std::string> names;
  names.reserve(from.meshes.size() + from.tetrahedra.size() + from.points.size());
  add_new_names(to, to.meshes, from.meshes, names);
  add_new_names(to, to.tetrahedra, from.tetrahedra, names);
  add_new_names(to, to.points, from.points, names);
  to.meshes.merge(from.meshes);
  to.tetrahedra.merge(from.tetrahedra);
  to.points.merge(from.points);
  return names;
}

void remove_arrays(SceneArrays& from, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    from.meshes.erase(name);
    from.tetrahedra.erase(name);
    from.points.erase(name);
  }
}

}  // namespace pliant::c
