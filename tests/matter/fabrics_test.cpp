// Tests the fabrics: the table in docs/guide/materials.md agrees with the code, and the numbers are physically
// possible.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>

#include "pliant/error.h"
#include "pliant/material.h"
#include "support/paths.h"

namespace pliant {
namespace {

std::string table_row(const Fabric& f) {
  char text[256];
  std::snprintf(text, sizeof text, "| %s | %g | %g | %g | %g | %.4g | %g | %g | %g | %g |", f.name.c_str(),
                double{f.area_density}, 1000 * double{f.thickness}, double{f.stretch_stiffness},
                double{f.weft_stiffness > 0 ? f.weft_stiffness : f.stretch_stiffness}, double{f.shear_stiffness},
                double{f.bending_stiffness}, double{f.bending_damping}, double{f.static_friction},
                double{f.kinetic_friction});
  return text;
}

/// The table that docs/guide/materials.md must contain; printed if it does not, to be copied.
std::string table() {
  std::string rows =
      "| name | kg/m^2 | thickness, mm | Y, N/m | weft, N/m | shear, N/m | B, N m | damping | static friction | "
      "kinetic "
      "friction |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Fabric& f : fabrics()) rows += table_row(f) + "\n";
  return rows;
}

/// With one space in place of each run of spaces and line ends, so that pages may wrap lines.
std::string in_one_line(const std::string& text) {
  std::istringstream words(text);
  std::string out, word;
  while (words >> word) out += word + " ";
  return out;
}

TEST(Fabrics, DocumentedTableIsTheTruth) {
  std::ifstream file(test::in_tree("docs/guide/materials.md"));
  ASSERT_TRUE(file) << "docs/guide/materials.md is missing";
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find(table()), std::string::npos) << "docs/guide/materials.md should hold\n" << table();
  for (const Fabric& f : fabrics()) {
    const std::string line = "- **" + f.name + "**: " + f.source;
    EXPECT_NE(in_one_line(text.str()).find(in_one_line(line)), std::string::npos)
        << "docs/guide/materials.md should hold\n"
        << line;
  }
}

TEST(Fabrics, AllThatWerePromisedAreThere) {
  std::set<std::string> names;
  for (const Fabric& f : fabrics()) names.insert(f.name);
  for (const char* name : {"cotton", "silk", "denim", "wool", "leather", "rubber sheet"}) {
    EXPECT_EQ(fabric(name).name, name);
    names.erase(name);
  }
  EXPECT_TRUE(names.empty());
}

TEST(Fabrics, NumbersArePossible) {
  for (const Fabric& f : fabrics()) {
    EXPECT_FALSE(f.source.empty());
    EXPECT_GT(f.area_density / f.thickness, 100) << f.name;   // density [kg/m^3] of a loose fabric
    EXPECT_LT(f.area_density / f.thickness, 1600) << f.name;  // density of cellulose without air
    EXPECT_LE(f.kinetic_friction, f.static_friction) << f.name;
    // Yarns that slide make a fabric softer in bending than a solid sheet of the same material, never stiffer.
    EXPECT_LE(f.bending_stiffness, f.stretch_stiffness * f.thickness * f.thickness / 9 * 1.0001f) << f.name;
    EXPECT_GT(f.bending_stiffness, 0) << f.name;
  }
}

TEST(Fabrics, RubberIsAHomogeneousSheet) {
  const Fabric& rubber = fabric("rubber sheet");
  EXPECT_FLOAT_EQ(rubber.stretch_stiffness, 1500);
  EXPECT_FLOAT_EQ(rubber.bending_stiffness, 1.5e6f * 1e-9f / 9);
}

TEST(Fabrics, UnknownNameListsTheOthers) {
  try {
    fabric("chainmail");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find("chainmail"), std::string::npos);
    EXPECT_NE(error.advice().find("denim"), std::string::npos);
  }
}

}  // namespace
}  // namespace pliant
