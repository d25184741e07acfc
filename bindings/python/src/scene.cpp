// Scenes: JSON text and arrays to a Description. The dict itself is Python's (../pliant/_scene.py).
#include <nanobind/stl/map.h>

#include <cmath>

#include "arrays.h"
#include "bindings.h"
#include "pliant/advise.h"
#include "pliant/describe.h"
#include "pliant/error.h"
#include "pliant/material.h"

namespace pliant::python {

namespace {

std::vector<Vec3f> points_of(nb::handle given, const std::string& what) {
  const Numbers numbers(given, 'f', 3, what.c_str());
  const std::span<const Vec3f> all = numbers.vectors();
  return {all.begin(), all.end()};
}

template <std::size_t Columns>
std::vector<std::array<int, Columns>> elements_of(nb::handle given, const std::string& what) {
  const Numbers numbers(given, 'i', Columns, what.c_str());
  std::vector<std::array<int, Columns>> elements(numbers.rows());
  const int* from = numbers.ints();
  for (std::array<int, Columns>& element : elements)
    for (int& index : element) index = *from++;
  return elements;
}

/// The two arrays of a mesh.
nb::sequence pair_of(nb::handle given, const std::string& name) {
  if (!nb::isinstance<nb::sequence>(given) || nb::len(given) != 2)
    throw Error({.element = "array '" + name + "'"}, "is no pair of two arrays", "pass (vertices, triangles)");
  return nb::borrow<nb::sequence>(given);
}

SceneArrays arrays_of(const nb::dict& meshes, const nb::dict& tetrahedra, const nb::dict& points) {
  SceneArrays arrays;
  for (const auto& [key, value] : meshes) {
    const auto name = nb::cast<std::string>(key);
    const nb::sequence parts = pair_of(value, name);
    arrays.meshes[name] = {points_of(nb::object(parts[0]), "the vertices of '" + name + "'"),
                           elements_of<3>(nb::object(parts[1]), "the triangles of '" + name + "'")};
  }
  for (const auto& [key, value] : tetrahedra) {
    const auto name = nb::cast<std::string>(key);
    const nb::sequence parts = pair_of(value, name);
    TetrahedralMesh& mesh = arrays.tetrahedra[name];
    mesh.positions = points_of(nb::object(parts[0]), "the points of '" + name + "'");
    mesh.tetrahedra = elements_of<4>(nb::object(parts[1]), "the tetrahedra of '" + name + "'");
  }
  for (const auto& [key, value] : points) {
    const auto name = nb::cast<std::string>(key);
    arrays.points[name] = points_of(value, "the points '" + name + "'");
  }
  return arrays;
}

Description describe(const std::string& text, const std::string& name, const std::string& folder,
                     const nb::dict& meshes, const nb::dict& tetrahedra, const nb::dict& points, bool allow_outside) {
  SceneReadOptions options;
  options.allow_outside = allow_outside;
  options.arrays = arrays_of(meshes, tetrahedra, points);
  const nb::gil_scoped_release release;
  return {std::make_shared<const SceneFile>(parse_scene_file(text, name, folder, options))};
}

nb::object finding(bool grave, const std::string& message, const std::string& advice) {
  return python_part("pliant._types", "Finding")(grave, message, advice);
}

nb::list check(const Description& description, double seconds) {
  if (!(seconds >= 0) || !std::isfinite(seconds))
    throw Error({}, "the seconds are negative or not finite", "pass 0 or more");
  std::vector<Finding> found;
  Advice advice;
  {
    const nb::gil_scoped_release release;
    found = inspect(description.scene());
    bool grave = false;
    for (const Finding& one : found) grave = grave || one.grave;
    const auto stops = [] {
      const nb::gil_scoped_acquire acquire;
      return PyErr_CheckSignals() != 0;
    };
    if (!grave && seconds > 0 && description.scene().frames > 0)
      advice = advise(description.scene(), {seconds, 120, stops});
  }
  if (PyErr_Occurred() != nullptr) throw nb::python_error();
  nb::list list;
  for (const Finding& one : found) list.append(finding(one.grave, one.message, one.advice));
  for (const std::string& warning : advice.warnings) list.append(finding(false, "in a trial run, " + warning, ""));
  if (!advice.words.empty()) list.append(finding(false, advice.words, advice.what_to_do));
  return list;
}

nb::dict dict_of(const Fabric& fabric) {
  nb::dict dict;
  dict["name"] = fabric.name;
  dict["area_density"] = fabric.area_density;
  dict["thickness"] = fabric.thickness;
  dict["stretch_stiffness"] = fabric.stretch_stiffness;
  dict["bending_stiffness"] = fabric.bending_stiffness;
  dict["bending_damping"] = fabric.bending_damping;
  dict["static_friction"] = fabric.static_friction;
  dict["kinetic_friction"] = fabric.kinetic_friction;
  dict["weft_stiffness"] = fabric.weft_stiffness;
  dict["shear_stiffness"] = fabric.shear_stiffness;
  dict["source"] = fabric.source;
  return dict;
}

nb::dict all_fabrics() {
  nb::dict all;
  for (const Fabric& fabric : fabrics()) all[fabric.name.c_str()] = dict_of(fabric);
  return all;
}

std::vector<std::string> names_of(const Description& description) {
  std::vector<std::string> names;
  names.reserve(description.scene().objects.size());
  for (const Object& object : description.scene().objects) names.push_back(object.name);
  return names;
}

nb::tuple mesh_tuple(const TriangleMesh& mesh) {
  const int* triangles = mesh.triangles.empty() ? nullptr : mesh.triangles.front().data();
  return nb::make_tuple(vectors(mesh.positions), int_rows(triangles, mesh.triangles.size(), 3));
}

}  // namespace

Description description_of(nb::handle scene) {
  static const nb::object* as_description = new nb::object(python_part("pliant._scene", "as_description"));
  return nb::cast<Description>((*as_description)(scene));
}

void bind_scene(nb::module_& m) {
  nb::class_<Description>(m, "Description", nb::type_slots(plain_slots()),
                          "A scene that was read and checked: what a World is made from.")
      .def_prop_ro(
          "frame_time", [](const Description& d) { return d.scene().frame_time; }, "Duration of a frame [s].")
      .def_prop_ro(
          "frames", [](const Description& d) { return d.scene().frames; }, "Default number of frames of a run.")
      .def_prop_ro(
          "repairs", [](const Description& d) { return d.file->repairs; }, "Repairs of meshes, doubts about robots.")
      .def_prop_ro(
          "left_out", [](const Description& d) { return d.file->left_out; }, "What fills left out.")
      .def_prop_ro("objects", &names_of, "Names of the objects.")
      .def(
          "describe", [](const Description& d) { return pliant::describe(d.scene()); },
          "What the scene holds, in lines.")
      .def("check", &check, nb::arg("seconds") = 0.0,
           nb::sig("def check(self, seconds: float = 0.0) -> list[pliant._types.Finding]"),
           "Findings of the scene, and of trial runs of about `seconds` [s].");
  m.def("describe", &describe, nb::arg("text"), nb::arg("name"), nb::arg("folder"), nb::arg("meshes"),
        nb::arg("tetrahedra"), nb::arg("points"), nb::arg("allow_outside"),
        nb::sig("def describe(text: str, name: str, folder: str, meshes: dict[str, typing.Any], tetrahedra: dict[str, "
                "typing.Any], "
                "points: dict[str, typing.Any], allow_outside: bool) -> Description"),
        "Reads a scene from JSON text and arrays.");
  m.def("fabrics", &all_fabrics, nb::sig("def fabrics() -> dict[str, dict[str, typing.Any]]"),
        "The built-in fabrics by name: their properties in SI units, and `source`, where the numbers come from.");
  m.def("scene_schema", &scene_schema, "The JSON Schema (2020-12) of the scene format as text.");
  m.def(
      "grid_mesh",
      [](int columns, int rows, float width, float depth) {
        return mesh_tuple(grid_mesh(columns, rows, width, depth));
      },
      nb::arg("columns"), nb::arg("rows"), nb::arg("width"), nb::arg("depth"),
      nb::sig("def grid_mesh(columns: int, rows: int, width: float, depth: float) -> pliant._types.Mesh"),
      "A flat rectangle of columns x rows vertices, width x depth [m], in the xz-plane about the origin, as (vertices, "
      "triangles).\n\n"
      "Vertex (row r, column c) has the index r * columns + c. Raises Error unless columns and rows are at least 2 and "
      "the "
      "sizes "
      "positive.");
  m.def(
      "sphere_mesh", [](int subdivisions) { return mesh_tuple(sphere_mesh(subdivisions)); }, nb::arg("subdivisions"),
      nb::sig("def sphere_mesh(subdivisions: int) -> pliant._types.Mesh"),
      "A closed unit sphere about the origin as (vertices, triangles): an icosahedron whose faces are split "
      "`subdivisions` "
      "times "
      "(0 to 7).");
  m.def(
      "read_mesh", [](const std::string& path) { return mesh_tuple(read_mesh(path)); }, nb::arg("path"),
      nb::sig("def read_mesh(path: str) -> pliant._types.Mesh"),
      "Reads an .obj, .ply or .stl file as (vertices [m], triangles). Polygons are triangulated; vertices with equal "
      "positions are "
      "merged. Raises Error with file and line if the file cannot be read.");
  m.def(
      "write_mesh",
      [](const std::string& path, nb::handle mesh) {
        const nb::sequence parts = pair_of(mesh, "mesh");
        write_mesh(path,
                   {points_of(nb::object(parts[0]), "vertices"), elements_of<3>(nb::object(parts[1]), "triangles")});
      },
      nb::arg("path"), nb::arg("mesh"), nb::sig("def write_mesh(path: str, mesh: pliant._types.MeshLike) -> None"),
      "Writes (vertices, triangles) as .obj or .ply. Raises Error if that fails; an existing file then stays "
      "unchanged.");
}

}  // namespace pliant::python
