// Real liquids in SI units. docs/guide/liquids.md has the same table; a test compares the two.
#include "pliant/error.h"
#include "pliant/liquid.h"

namespace pliant {

const std::vector<LiquidKind>& liquids() {
  static const std::vector<LiquidKind> all{
      {"water", 998, 0.001f, "20 °C: 998.2 kg/m^3 and 1.002 mPa s (IAPWS)"},
      {"oil", 915, 0.08f, "typical of olive oil at 20 °C"},
      {"glycerine", 1261, 1.41f,
       "pure, 20 °C: 1410 cP (Segur and Oberstar, Ind. Eng. Chem. 43, 1951); water in it thins it much"},
      {"honey", 1420, 10, "typical at 20 to 25 °C; kinds differ between 2 and 30 Pa s, and warm honey is thinner"},
  };
  return all;
}

const LiquidKind& liquid(std::string_view name) {
  std::string names;
  for (const LiquidKind& each : liquids()) {
    if (each.name == name) return each;
    names += (names.empty() ? "" : ", ") + each.name;
  }
  throw Error({}, "there is no liquid '" + std::string(name) + "'", "choose one of " + names + ", or fill in a Fluid");
}

}  // namespace pliant
