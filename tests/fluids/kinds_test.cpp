// Real liquids: the page has the same table, and what scenes get.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "pliant/error.h"
#include "pliant/liquid.h"
#include "support/paths.h"

namespace pliant {
namespace {

std::string number(float value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

TEST(KindsOfLiquid, AreThoseOfThePage) {
  std::ifstream file(test::in_tree("docs/guide/liquids.md"));
  std::stringstream page;
  page << file.rdbuf();
  std::string table = "| kind | density, kg/m^3 | viscosity, Pa s | surface tension, N/m |\n|---|---|---|---|\n";
  for (const LiquidKind& of : liquids())
    table += "| " + of.name + " | " + number(of.density) + " | " + number(of.viscosity) + " | " +
             number(of.surface_tension) + " |\n";
  EXPECT_NE(page.str().find(table), std::string::npos) << table;
  for (const LiquidKind& of : liquids()) {
    const std::string line = "- **" + of.name + "**: " + of.source + "\n";
    EXPECT_NE(page.str().find(line), std::string::npos) << line;
  }
}

TEST(KindsOfLiquid, AreInTheTableOfMaterials) {
  std::ifstream file(test::in_tree("docs/guide/materials.md"));
  std::stringstream page;
  page << file.rdbuf();
  for (const LiquidKind& of : liquids()) {
    const std::string row = "| " + of.name + " | `\"kind\": \"" + of.name + "\"` | " + number(of.density) + " | " +
                            number(of.viscosity) + " | " + number(of.surface_tension) + " | - |\n";
    EXPECT_NE(page.str().find(row), std::string::npos) << row;
  }
}

TEST(KindsOfLiquid, AreFoundByName) {
  for (const char* name : {"water", "oil", "glycerine", "honey"}) EXPECT_EQ(liquid(name).name, name);
  EXPECT_GT(liquid("honey").viscosity, 1000 * liquid("water").viscosity);
  try {
    liquid("tar");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("glycerine"), std::string::npos);
  }
}

}  // namespace
}  // namespace pliant
