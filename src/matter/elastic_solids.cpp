// Elastic solids in SI units. docs/guide/soft_bodies.md has the same table; a test compares the two.
#include <string>

#include "matter/presets.h"
#include "pliant/soft_body.h"

namespace pliant {

namespace {

std::vector<ElasticSolid> make_solids() {
  return {
      {"gelatine", 1050, 8e3f, 0.45f, 0.002f, 0.4f, 0.3f,
       "typical of a dessert jelly of 5 to 10 % gelatine, 3 to 20 kPa; it is water, which hardly yields"},
      {"rubber", 950, 1.5e6f, 0.47f, 0.0001f, 0.9f, 0.8f,
       "typical of soft natural rubber, 1 to 2 MPa at small strain; nearly incompressible"},
      {"foam", 30, 5e4f, 0.2f, 0.0002f, 0.7f, 0.6f,
       "typical of flexible polyurethane foam for upholstery, 20 to 45 kg/m^3 and 20 to 100 kPa at small strain"},
      {"muscle", 1060, 2e4f, 0.45f, 0.002f, 0.5f, 0.4f,
       "typical of relaxed skeletal muscle across its fibres, 10 to 50 kPa at small strain"},
  };
}

}  // namespace

const std::vector<ElasticSolid>& elastic_solids() {
  static const std::vector<ElasticSolid> all = make_solids();
  return all;
}

const ElasticSolid& elastic_solid(std::string_view name) {
  return preset_named(elastic_solids(), name, "there is no elastic solid", "an ElasticSolid");
}

}  // namespace pliant
