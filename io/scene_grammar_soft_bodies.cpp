// The table of the scene format: soft bodies.
#include "pliant/soft_body.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

std::vector<std::string> solid_names() { return names_of(elastic_solids()); }

const Record& elastic_solid_record() {
  static const Record result{
      "elastic solid",
      "An elastic solid in SI units, independent of the mesh. Missing members come from `base`, or else from the "
      "defaults.",
      {field("base", choice(solid_names()), "none", "A built-in elastic solid to start from."),
       field("name", string(), "none", "Its name."), field("source", text(), "none", "Source of the numbers."),
       field("density", positive("kg/m^3", 1e12), ElasticSolid{}.density, "Mass per volume."),
       field("youngs_modulus", positive("Pa", 1e15), ElasticSolid{}.youngs_modulus,
             "Young's modulus: stress per strain of a bar that is pulled."),
       field("poisson_ratio", number("-", 0, 0.495), ElasticSolid{}.poisson_ratio,
             "Poisson's ratio: how much narrower the bar becomes per strain."),
       field("model", choice({"neo_hookean", "corotational", "st_venant_kirchhoff"}), "neo_hookean",
             "How its energy grows with the strain: all follow Hooke's law at small strain."),
       field("damping", number("s", 0, 1e6), ElasticSolid{}.damping,
             "Viscous stress over the elastic modulus times the rate of strain."),
       field("static_friction", number("-", 0, 1000), ElasticSolid{}.static_friction,
             "Coefficient of static friction."),
       field("kinetic_friction", number("-", 0, 1000), "0.5; at most the static one",
             "Coefficient of kinetic friction, at most the static one."),
       field("plasticity", record(plasticity_record()), "none",
             "Strain beyond which it keeps the new shape, at constant volume.")},
      {}};
  return result;
}

const Record& fibres_record() {
  static const Record result{
      "fibres",
      "Fibres along one direction, which stiffen the solid, and shorten where it is a muscle.",
      {field("direction", vector("-", largest_place), Fibres{}.direction,
             "Their direction in the rest shape, of any length but 0."),
       field("modulus", positive("Pa", 1e15), Fibres{}.modulus,
             "Stress per strain along the fibre, besides that of the solid."),
       field("stretch", list(record(rest_keyframe_record()), 1), "1 at all times",
             "The length that fibres want over their length at rest: 0.6 where a muscle contracts "
             "by 40 %. Linear between times.")},
      {}};
  return result;
}

const Record& tetrahedral_box_record() {
  static const Record result{"box of tetrahedra",
                             "A box about the origin, of cubes that are cut into six tetrahedra each.",
                             {needed("size", positive_vector("m", largest_place), "Sizes along x, y and z."),
                              needed("cells", list(integer(1, 1 << 20), 3, 3), "Number of cubes along x, y and z."),
                              field("cut", choice({"alike", "mirrored"}), "alike",
                                    "Whether all cubes are cut along the same diagonal, or those on both sides of the "
                                    "middle as mirror images, so that what is dropped level bounces up and not aside. "
                                    "Give even numbers of cubes then.")},
                             {}};
  return result;
}

const Record& tetrahedra_record() {
  static const Record result{
      "tetrahedra",
      "The source of tetrahedra and their placement: fitted, then scaled, then rotated, then moved. The result is also "
      "the "
      "rest shape.",
      {either(
           "file", string(),
           "Path of a tetrahedral mesh, relative to the folder of the scene: TetGen .node or .ele, Gmsh .msh, VTK .vtk "
           "or .vtu, "
           "Medit .mesh or .meshb, or "
           ".t (docs/guide/soft_bodies.md)."),
       either("array", string(), "Name of tetrahedra in memory that the program gives with the scene."),
       either("box", record(tetrahedral_box_record()), "A box."),
       field("fit", positive("m", largest_place), "none",
             "Scales and moves the mesh so that its longest side has this length, its centre lies above the origin and "
             "its "
             "lowest point at y = 0."),
       field("scale", any_of({positive("-", 1e6), positive_vector("-", 1e6)}), 1,
             "Scale factor, one for all axes or one per axis."),
       field("rotate", record(rotation_record()), "none", "Rotation about the origin."),
       field("translate", place(), Vec3f{}, "Translation.")},
      {"file", "array", "box"}};
  return result;
}

}  // namespace

const Record& soft_body_record() {
  static const Record result{
      "soft body",
      "An elastic solid of tetrahedra. Its border is its surface.",
      {either("tetrahedra", record(tetrahedra_record()), "Its tetrahedra."),
       either("mesh", record(mesh_record()), "A closed surface, which is filled with tetrahedra of edges of `size`."),
       field("size", positive("m", largest_place), "an eighth of the longest side, less if it is thin",
             "Only for a mesh: length of the edges of tetrahedra."),
       field("material", any_of({choice(solid_names()), record(elastic_solid_record())}),
             "the defaults of elastic solid",
             "The material: the name of a built-in elastic solid, or an elastic solid."),
       field("fibres", record(fibres_record()), "none", "Fibres in it: a muscle."),
       field("strain_limit", record(strain_limit_record()), "none", "How far the edges of its tetrahedra may stretch."),
       field("skin", any_of({boolean(), record(mesh_record())}), false,
             "A surface that moves with it, which pictures and files show instead of its border: true for the `mesh` "
             "that is "
             "filled, or another mesh.")},
      {"tetrahedra", "mesh"}};
  return result;
}

}  // namespace pliant::scene_file
