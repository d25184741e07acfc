// Builds soft bodies in scene files.
#include <algorithm>
#include <cmath>
#include <string>

#include "pliant/soft_body.h"
#include "scene_build.h"
#include "scene_grammar.h"
#include "scene_mesh.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

ElasticSolid solid_of(const JsonDocument& document, const JsonValue& at) {
  if (at.kind == JsonValue::Kind::string) return elastic_solid(at.text);
  ElasticSolid solid;
  if (const JsonValue* base = at.find("base")) solid = elastic_solid(base->text);
  set(at, "name", solid.name);
  set(at, "source", solid.source);
  set(at, "density", solid.density);
  set(at, "youngs_modulus", solid.youngs_modulus);
  set(at, "poisson_ratio", solid.poisson_ratio);
  std::string model;
  set(at, "model", model);
  if (model == "neo_hookean") solid.model = SolidModel::neo_hookean;
  if (model == "corotational") solid.model = SolidModel::corotational;
  if (model == "st_venant_kirchhoff") solid.model = SolidModel::st_venant_kirchhoff;
  set(at, "damping", solid.damping);
  set_friction(document, at, solid.static_friction, solid.kinetic_friction);
  set(at, "plasticity", solid.plasticity);
  return solid;
}

Fibres fibres_of(const JsonDocument& document, const JsonValue& at) {
  Fibres fibres;
  set(at, "direction", fibres.direction);
  set(at, "modulus", fibres.modulus);
  set(document, at, "stretch", fibres.stretch);
  return fibres;
}

TetrahedralMesh box_of(const JsonDocument& document, const JsonValue& at) {
  constexpr int most_tetrahedra = largest_scene, tetrahedra_of_cell = 6;
  Vec3f size;
  set(at, "size", size);
  std::array<int, 3> cells{};
  double tetrahedra = tetrahedra_of_cell;
  const JsonValue& list = *at.find("cells");
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i] = static_cast<int>(list.items[i].number);
    tetrahedra *= cells[i];
  }
  if (tetrahedra > most_tetrahedra)
    document.fail(list, "more than " + std::to_string(most_tetrahedra) + " tetrahedra", "use fewer cells");
  std::string cut;
  set(at, "cut", cut);
  return box_tetrahedra(size, cells, cut == "mirrored" ? BoxCut::mirrored : BoxCut::alike);
}

/// Names of repairs in a scene: of an object, and of the file if it was read from one.
struct Notes {
  const std::string& object;
  std::vector<std::string>& repairs;

  void add(const std::string& source, const std::vector<std::string>& notes) const {
    for (const std::string& one : notes)
      repairs.push_back("object '" + object + "', " + (source.empty() ? "" : source + ": ") + one);
  }
};

TetrahedralMesh tetrahedra_of(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder,
                              const Notes& notes) {
  TetrahedralMesh mesh;
  if (const JsonValue* box = at.find("box")) mesh = box_of(document, *box);
  if (const JsonValue* file = at.find("file")) {
    TetrahedralMeshFile read = read_tetrahedral_mesh(allowed_path(document, *file, folder));
    mesh = std::move(read.mesh);
    notes.add(file->text, read.repairs);
  }
  if (const JsonValue* array = at.find("array")) mesh = tetrahedra_named(document, *array, folder);
  place(document, at, mesh.positions);
  return mesh;
}

/// An eighth of the longest side, and less where the body is thinner than that: of a plate, three quarters of its
/// thickness. But never less than a 64th.
float default_size(const TriangleMesh& mesh) {
  const MeshBounds bounds = bounds_of(mesh.positions);
  const float longest = bounds.longest_side();
  double six_volumes = 0, two_areas = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto from_low = [&](int corner) {
      const Vec3f p = mesh.positions[static_cast<std::size_t>(corner)] - bounds.low;
      return Vec3d{p.x, p.y, p.z};
    };
    six_volumes += dot(cross(from_low(a), from_low(b)), from_low(c));
    const Vec3d normal = cross(from_low(b) - from_low(a), from_low(c) - from_low(a));
    two_areas += std::sqrt(dot(normal, normal));
  }
  const double thin = two_areas > 0 ? 1.5 * (std::fabs(six_volumes) / 6) / (two_areas / 2) : 0;
  return std::clamp(static_cast<float>(thin), longest / 64, longest / 8);
}

TetrahedralMesh filled(const JsonValue& at, const SceneMesh& surface, const Notes& notes) {
  float size = 0;
  if (!set(at, "size", size) && !surface.mesh.positions.empty()) size = default_size(surface.mesh);
  FilledMesh result = fill_with_tetrahedra(surface.mesh, size);
  notes.add("", result.notes);
  return std::move(result.mesh);
}

/// Gives a body the skin of its record `at`, if it has one. `surface` is what it was filled from, or null.
void set_skin(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder, const TriangleMesh* surface,
              const Notes& notes, Object& body) {
  const JsonValue* skin = at.find("skin");
  if (skin == nullptr) return;
  if (skin->kind == JsonValue::Kind::object) {
    const SceneMesh own = make_mesh(document, *skin, folder, notes.object);
    notes.add("skin", own.repairs);
    body.skin = make_skin(body, own.mesh);
    return;
  }
  if (!skin->truth) return;
  if (surface == nullptr)
    document.fail_key(*skin, "of `tetrahedra` must say what mesh it is",
                      "give a mesh, such as {\"file\": \"skin.obj\"}");
  body.skin = make_skin(body, *surface);
}

}  // namespace

BuiltObject soft_body_of(const JsonDocument& document, const JsonValue& at, const std::string& name,
                         const MeshFolder& folder, std::vector<std::string>& repairs) {
  SoftBodyOptions options;
  options.name = name;
  if (const JsonValue* material = at.find("material")) options.material = solid_of(document, *material);
  if (const JsonValue* fibres = at.find("fibres")) options.fibres = fibres_of(document, *fibres);
  set(at, "strain_limit", options.strain_limit);
  const Notes notes{name, repairs};
  if (const JsonValue* tetrahedra = at.find("tetrahedra")) {
    if (const JsonValue* size = at.find("size"))
      document.fail_key(*size, "is only for a mesh", "remove it, or scale the tetrahedra");
    BuiltObject built{make_soft_body(tetrahedra_of(document, *tetrahedra, folder, notes), options)};
    set_skin(document, at, folder, nullptr, notes, built.object);
    return built;
  }
  const SceneMesh surface = make_mesh(document, *at.find("mesh"), folder, name);
  notes.add("", surface.repairs);
  BuiltObject built{make_soft_body(filled(at, surface, notes), options)};
  set_skin(document, at, folder, &surface.mesh, notes, built.object);
  return built;
}

}  // namespace pliant::scene_file
