// Real liquids in SI units. docs/guide/liquids.md has the same table; a test compares the two.
#include "matter/presets.h"
#include "pliant/liquid.h"

namespace pliant {

const std::vector<LiquidKind>& liquids() {
  static const std::vector<LiquidKind> all{
      {"water", 998, 0.001f, 0.0728f, "20 °C: 998.2 kg/m^3 and 1.002 mPa s, 72.75 mN/m (IAPWS)"},
      {"oil", 915, 0.08f, 0.032f, "typical of olive oil at 20 °C, 32 mN/m"},
      {"glycerine", 1261, 1.41f, 0.063f,
       "pure, 20 °C: 1410 cP (Segur and Oberstar, Ind. Eng. Chem. 43, 1951), 63 mN/m (Handbook of Chemistry and "
       "Physics); "
       "water in it thins it much"},
      {"honey", 1420, 10, 0.06f,
       "typical at 20 to 25 °C; kinds differ between 2 and 30 Pa s, and warm honey is thinner; 50 to 65 mN/m"},
  };
  return all;
}

const LiquidKind& liquid(std::string_view name) {
  return preset_named(liquids(), name, "there is no liquid", "a Fluid");
}

}  // namespace pliant
