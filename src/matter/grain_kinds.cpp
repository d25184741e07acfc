// Real granular materials in SI units. docs/guide/grains.md has the same table; a test compares the two.
#include "matter/presets.h"
#include "pliant/grains.h"

namespace pliant {

const std::vector<GrainKind>& grain_kinds() {
  static const std::vector<GrainKind> all{
      {"dry sand", 2650, 0.6f, 0,
       "quartz; 31 degrees, between round and angular grains, loose (Terzaghi and Peck, Soil Mechanics in Engineering "
       "Practice, 1967)"},
      {"wet sand", 2900, 0.65f, 1000,
       "angular grains of quartz, with a tenth of their weight in water; tensile strength typical of moist fine sand, "
       "0.5 "
       "to "
       "1.5 kPa (Lu, Wu and Tan, J. Geotech. Geoenviron. Eng. 133, 2007)"},
      {"gravel", 2650, 0.7f, 0, "quartz; 35 degrees, sandy gravel, loose (Terzaghi and Peck 1967)"},
  };
  return all;
}

const GrainKind& grain_kind(std::string_view name) {
  return preset_named(grain_kinds(), name, "there are no grains", "a Grains");
}

}  // namespace pliant
