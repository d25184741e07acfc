// Materials of rods in SI units. docs/guide/rods.md has the same table; a test compares the two.
#include <string>

#include "matter/presets.h"
#include "pliant/rod.h"

namespace pliant {

namespace {

std::vector<RodMaterial> make_materials() {
  return {
      {"steel wire", 7850, 2e11f, 7.9e10f, 1e-5f, 0.3f, 0.25f,
       "typical of drawn carbon steel: 195 to 210 GPa, and 78 to 80 GPa in shear"},
      {"copper wire", 8960, 1.2e11f, 4.5e10f, 2e-5f, 0.4f, 0.35f,
       "typical of pure copper: 110 to 128 GPa, and 44 to 48 GPa in shear"},
      {"nylon line", 1140, 2.5e9f, 9e8f, 0.0005f, 0.25f, 0.2f,
       "typical of a nylon monofilament: 2 to 4 GPa, less where it is wet"},
      {"hair", 1320, 4e9f, 1e9f, 0.0005f, 0.25f, 0.2f,
       "typical of human scalp hair in dry air: 3 to 6 GPa, and about 1 GPa in torsion; its radius is 25 to 50 "
       "micrometres"},
      {"rubber cord", 1100, 3e6f, 1e6f, 0.0005f, 0.9f, 0.8f,
       "typical of vulcanised natural rubber of 50 Shore A at small strain: 2 to 4 MPa, a third of it in shear"},
      {"bamboo", 700, 1.5e10f, 1e9f, 0.0002f, 0.5f, 0.4f,
       "typical of dry bamboo along its fibres: 10 to 20 GPa, and about 1 GPa in shear"},
      {"rope",
       790,
       6e8f,
       2e8f,
       0.005f,
       0.5f,
       0.4f,
       "a laid polyamide rope: 62 g/m at 10 mm, and 20 kN at a stretch by about 40 % (ISO 1140:2012); its share of "
       "bending "
       "is a sensible "
       "choice",
       {},
       0.02f},
  };
}

}  // namespace

const std::vector<RodMaterial>& rod_materials() {
  static const std::vector<RodMaterial> all = make_materials();
  return all;
}

const RodMaterial& rod_material(std::string_view name) {
  return preset_named(rod_materials(), name, "there is no material of rods", "a RodMaterial");
}

}  // namespace pliant
