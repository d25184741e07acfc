// Restricts which files a scene may name: regular files and, for an untrusted scene, only files below its own folder
// after links are resolved. Scenes can come from anywhere, and must not make a program wait for a pipe, read a device,
// or publish a private file.
#include "scene_mesh.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "pliant/io.h"
#include "scene_grammar.h"
#include "scene_hints.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

namespace fs = std::filesystem;

bool is_url(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon < 2) return false;
  const auto of_scheme = [](unsigned char c) { return std::isalnum(c) != 0 || c == '+' || c == '.' || c == '-'; };
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon), of_scheme);
}

bool leaves_folder(const fs::path& path) {
  return path.is_absolute() || std::find(path.begin(), path.end(), fs::path("..")) != path.end();
}

}  // namespace

bool lies_below(const std::string& path, const std::string& folder) {
  std::error_code no_path, no_folder;
  const fs::path inner = fs::weakly_canonical(path, no_path);  // the file may be missing
  const fs::path outer = fs::canonical(folder, no_folder);
  if (no_path || no_folder) return false;
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

std::string allowed_path(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder) {
  if (is_url(at.text)) document.fail(at, "this is a URL", "name a file beside the scene");
  const fs::path home = folder.path.empty() ? fs::path(".") : fs::path(folder.path);
  const fs::path path = folder.path.empty() ? fs::path(at.text) : home / at.text;
  const char* advice = "put the file into the scene's folder, or permit files outside it";
  if (!folder.allow_outside && leaves_folder(at.text)) document.fail(at, "this path leaves the scene's folder", advice);
  std::error_code unknown;
  const fs::file_status status = fs::status(path, unknown);
  if (!fs::exists(status))
    document.fail(at, "there is no file " + printable(path.string()), "the path is relative to the scene");
  if (!fs::is_regular_file(status))
    document.fail(at, printable(path.string()) + " is not a regular file", "name a regular file");
  if (!folder.allow_outside && !lies_below(path.string(), home.string()))
    document.fail(at, "this link leaves the scene's folder", advice);
  return path.string();
}

namespace {

TriangleMesh grid_of(const JsonValue& at, SceneMesh& result) {
  float width = 0, depth = 0;
  set(at, "columns", result.columns);
  set(at, "rows", result.rows);
  set(at, "width", width);
  set(at, "depth", depth);
  return grid_mesh(result.columns, result.rows, width, depth);
}

TriangleMesh sphere_of(const JsonValue& at) {
  int subdivisions = 0;
  float radius = 1;
  set(at, "subdivisions", subdivisions);
  set(at, "radius", radius);
  TriangleMesh mesh = sphere_mesh(subdivisions);
  for (Vec3f& p : mesh.positions) p = radius * p;
  return mesh;
}

TriangleMesh tube_of(const JsonValue& at) {
  int columns = 0, rows = 0, folds = 0;
  float length = 0, top_radius = 0, bottom_radius = 0, fold_depth = 0;
  set(at, "columns", columns);
  set(at, "rows", rows);
  set(at, "length", length);
  set(at, "top_radius", top_radius);
  set(at, "bottom_radius", bottom_radius);
  set(at, "folds", folds);
  set(at, "fold_depth", fold_depth);
  return tube_mesh(columns, rows, length, top_radius, bottom_radius, folds, fold_depth);
}

TriangleMesh box_of(const JsonValue& at) {
  Vec3f size;
  int segments = 1;
  set(at, "size", size);
  set(at, "segments", segments);
  return box_mesh(size, segments);
}

TriangleMesh rabbit_of(const JsonValue& at) {
  float height = 0.3f;
  int cells = 40;
  set(at, "height", height);
  set(at, "cells", cells);
  return rabbit_mesh(height, cells);
}

float wave(float turns) { return rotated(rotation({0, 0, 1}, 360 * turns), {1, 0, 0}).y; }

/// Raises vertices by a formula of waves. The phase is computed from the vertex index, so that opposite borders match.
void raise(const JsonValue& at, int columns, int rows, TriangleMesh& mesh) {
  float height = 0, along_x = 1, along_z = 1;
  set(at, "height", height);
  set(at, "along_x", along_x);
  set(at, "along_z", along_z);
  const auto turns = [](int i, int count, float waves) {
    return waves * (static_cast<float>(2 * i - (count - 1)) / static_cast<float>(2 * (count - 1)));
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      mesh.positions[static_cast<std::size_t>(r) * columns + c].y =
          height * wave(turns(c, columns, along_x)) * wave(turns(r, rows, along_z));
}

TriangleMesh heightfield_of(const JsonDocument& document, const JsonValue& at, SceneMesh& result) {
  TriangleMesh mesh = grid_of(at, result);
  if (const JsonValue* waves = at.find("waves")) raise(*waves, result.columns, result.rows, mesh);
  const JsonValue* heights = at.find("heights");
  if (heights == nullptr) return mesh;
  if (heights->items.size() != mesh.positions.size())
    document.fail(
        *heights,
        std::to_string(heights->items.size()) + " heights for " + std::to_string(mesh.positions.size()) + " vertices",
        "give columns x rows heights");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i].y = static_cast<float>(heights->items[i].number);
  return mesh;
}

/// Sets a placement that scales the mesh to a longest side of `size` [m], centres it above the origin and puts its
/// lowest point at y = 0.
void fit(const std::vector<Vec3f>& positions, float size, Placement& placement) {
  if (positions.empty()) return;
  const MeshBounds bounds = bounds_of(positions);
  const Vec3f &low = bounds.low, &high = bounds.high;
  const float longest = bounds.longest_side();
  if (longest > 0) placement.fit = size / longest;
  placement.fit_offset = -placement.fit * Vec3f{0.5f * (low.x + high.x), low.y, 0.5f * (low.z + high.z)};
}

Placement placement_of(const JsonDocument& document, const JsonValue& at, const std::vector<Vec3f>& positions) {
  Placement placement;
  float size = 0;
  if (set(at, "fit", size)) fit(positions, size, placement);
  if (const JsonValue* value = at.find("scale")) {
    const float factor = static_cast<float>(value->number);
    placement.scale = value->kind == JsonValue::Kind::array ? vector_of(*value) : Vec3f{factor, factor, factor};
  }
  placement.turns = set(document, at, "rotate", placement.turn);
  set(at, "translate", placement.translation);
  return placement;
}

void check_places(const JsonDocument& document, const JsonValue& at, const std::vector<Vec3f>& positions) {
  const auto inside = [](float x) { return x >= -largest_place && x <= largest_place; };  // false for NaN
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3f& p = positions[i];
    if (std::isnan(p.x + p.y + p.z))
      document.fail(at, "vertex " + std::to_string(i) + " is not finite", "mend the mesh");
    if (!inside(p.x) || !inside(p.y) || !inside(p.z))
      document.fail(at, "vertex " + std::to_string(i) + " lies more than 1000 km from the origin",
                    "scale or move the mesh");
  }
}

/// What the array of that name has, whatever its kind; empty if there is none.
std::string contents_of(const std::string& name, const SceneArrays& arrays) {
  if (arrays.meshes.count(name) > 0) return "triangles";
  if (arrays.tetrahedra.count(name) > 0) return "tetrahedra";
  return arrays.points.count(name) > 0 ? "points alone" : "";
}

/// What the scene calls by the name `at`, of the arrays in memory. `needed`: what it has to have.
template <class Array>
const Array& array_named(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder,
                         std::map<std::string, Array> SceneArrays::*kind, const char* needed) {
  static const SceneArrays none;
  const SceneArrays& arrays = folder.arrays == nullptr ? none : *folder.arrays;
  const std::map<std::string, Array>& of_kind = arrays.*kind;
  if (const auto found = of_kind.find(at.text); found != of_kind.end()) return found->second;
  if (const std::string other = contents_of(at.text, arrays); !other.empty())
    document.fail(at, "array " + printable(at.text) + " has " + other + ", but " + needed + " are needed here",
                  "give it with " + std::string(needed));
  std::vector<std::string> names;
  names.reserve(of_kind.size());
  for (const auto& [name, array] : of_kind) names.push_back(name);
  const std::string nearest = nearest_name(at.text, names);
  document.fail(at, "there is no array " + printable(at.text) + " of this kind",
                nearest.empty() ? "give an array of this name with the scene, or name a 'file'"
                                : "the nearest name is '" + printable(nearest) + "'");
}

/// Throws an Error if a triangle or tetrahedron has a vertex that is not there.
template <class Element>
void check_indices(const JsonDocument& document, const JsonValue& at, const std::vector<Element>& elements,
                   std::size_t vertices, const char* kind) {
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (const int vertex : elements[i])
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertices)
        document.fail(at,
                      std::string(kind) + " " + std::to_string(i) + " of array " + printable(at.text) + " has vertex " +
                          std::to_string(vertex) + ", but there are " + std::to_string(vertices),
                      "give indices from 0 to " + std::to_string(static_cast<std::ptrdiff_t>(vertices) - 1));
}

TriangleMesh mesh_named(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder) {
  TriangleMesh mesh = array_named(document, at, folder, &SceneArrays::meshes, "triangles");
  check_indices(document, at, mesh.triangles, mesh.positions.size(), "triangle");
  return mesh;
}

MeshFile read(const std::string& path, Repair repair) {
  const bool mends = repair == Repair::yes;
  return read_mesh_file(path, {mends, mends, mends});
}

/// Reads the file that replaces the object's mesh, or else the source that the record names.
void fill(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder, const std::string& name,
          Repair repair, SceneMesh& result) {
  const auto from_file = [&](const std::string& path, const std::string& called) {
    MeshFile file = read(path, repair);
    result.mesh = std::move(file.mesh);
    for (const std::string& one : file.repairs) result.repairs.push_back(called + ": " + one);
  };
  if (const auto instead = folder.instead.find(name); instead != folder.instead.end()) {
    for (const char* source : {"file", "array", "grid", "sphere", "tube", "box", "heightfield", "rabbit"})
      if (const JsonValue* unused = at.find(source)) unused->ignore();
    return from_file(instead->second, instead->second);
  }
  if (const JsonValue* file = at.find("file")) from_file(allowed_path(document, *file, folder), file->text);
  if (const JsonValue* array = at.find("array")) result.mesh = mesh_named(document, *array, folder);
  if (const JsonValue* grid = at.find("grid")) result.mesh = grid_of(*grid, result);
  if (const JsonValue* sphere = at.find("sphere")) result.mesh = sphere_of(*sphere);
  if (const JsonValue* tube = at.find("tube")) result.mesh = tube_of(*tube);
  if (const JsonValue* box = at.find("box")) result.mesh = box_of(*box);
  if (const JsonValue* rabbit = at.find("rabbit")) result.mesh = rabbit_of(*rabbit);
  if (const JsonValue* heightfield = at.find("heightfield"))
    result.mesh = heightfield_of(document, *heightfield, result);
}

}  // namespace

float MeshBounds::longest_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }

MeshBounds bounds_of(const std::vector<Vec3f>& positions) {
  MeshBounds box{positions.front(), positions.front()};
  for (const Vec3f& p : positions) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

Vec3f Placement::place(const Vec3f& p) const {
  Vec3f q = fit == 1 && fit_offset == Vec3f{} ? p : fit * p + fit_offset;
  q = {q.x * scale.x, q.y * scale.y, q.z * scale.z};
  return (turns ? rotated(turn, q) : q) + translation;
}

Placement place(const JsonDocument& document, const JsonValue& at, std::vector<Vec3f>& positions) {
  const Placement placement = placement_of(document, at, positions);
  for (Vec3f& p : positions) p = placement.place(p);
  check_places(document, at, positions);
  return placement;
}

SceneMesh make_mesh(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder,
                    const std::string& name, Repair repair) {
  SceneMesh result;
  fill(document, at, folder, name, repair, result);
  result.placement = place(document, at, result.mesh.positions);
  return result;
}

TetrahedralMesh tetrahedra_named(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder) {
  TetrahedralMesh mesh = array_named(document, at, folder, &SceneArrays::tetrahedra, "tetrahedra");
  check_indices(document, at, mesh.tetrahedra, mesh.positions.size(), "tetrahedron");
  return mesh;
}

std::vector<Vec3f> positions_at(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder) {
  const JsonValue* positions = at.find("positions");
  if (positions == nullptr) return {};
  std::vector<Vec3f> places;
  if (positions->kind == JsonValue::Kind::object) {
    places = array_named(document, *positions->find("array"), folder, &SceneArrays::points, "points alone");
    check_places(document, *positions, places);
    return places;
  }
  places.reserve(positions->items.size());
  for (const JsonValue& place : positions->items) places.push_back(vector_of(place));
  return places;
}

std::vector<Vec3f> make_frame(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder,
                              const SceneMesh& mesh) {
  TriangleMesh frame;
  if (const JsonValue* file = at.find("file")) frame = read(allowed_path(document, *file, folder), Repair::no).mesh;
  if (at.find("positions") != nullptr) frame.positions = positions_at(document, at, folder);
  if (frame.positions.size() != mesh.mesh.positions.size())
    document.fail(at,
                  "this frame has " + std::to_string(frame.positions.size()) + " vertices, the mesh " +
                      std::to_string(mesh.mesh.positions.size()),
                  "give one position per vertex of the mesh, in its order");
  for (Vec3f& p : frame.positions) p = mesh.placement.place(p);
  check_places(document, at, frame.positions);
  return frame.positions;
}

}  // namespace pliant::scene_file
