// Measured fabrics of the textile trade in SI units. docs/guide/materials.md
// has the same table, how to read it and its accuracy; a test compares the two.
//
// The Kawabata evaluation system (KES-F) reports bending rigidity per width in gf cm^2/cm (1
// = 9.81e-5 N m). It also reports the extension at 500 gf/cm (490 N/m); the secant membrane
// stiffness is 490 N/m over the strain. Woven fabrics vary by a factor of three or more,
// differ between warp and weft, and stiffen as they stretch. Each number is a typical value.
#include <string>

#include "matter/presets.h"
#include "pliant/material.h"

namespace pliant {

namespace {

/// `shear` is in gf/cm for a degree, as KES-F reports it: 9.81e-3 N over 0.01 m and 0.01745.
Fabric woven(const char* name, float area_density, float thickness, float warp, float weft, float shear, float bending,
             float static_friction, float kinetic_friction, const char* source) {
  return {name,   area_density, thickness,    warp, bending, 0.05f, static_friction, kinetic_friction,
          source, weft,         56.2f * shear};
}

/// A homogeneous sheet of thickness t: membrane stiffness E t and bending rigidity E t^3 / (12 (1 - nu^2)).
Fabric sheet(const char* name, double density, double thickness, double young, double poisson, float damping,
             float static_friction, float kinetic_friction, const char* source) {
  return {name,
          static_cast<float>(density * thickness),
          static_cast<float>(thickness),
          static_cast<float>(young * thickness),
          static_cast<float>(young * thickness * thickness * thickness / (12 * (1 - poisson * poisson))),
          damping,
          static_friction,
          kinetic_friction,
          source,
          0,
          static_cast<float>(young * thickness / (2 * (1 + poisson)))};
}

std::vector<Fabric> make_fabrics() {
  return {
      woven("cotton", 0.12f, 0.0003f, 7000, 4500, 0.9f, 1.75e-5f, 0.4f, 0.3f,
            "plain-woven cotton of 120 g/m^2: bending for the measured drape coefficient of plain weave, 80 % (KES-F: "
            "0.18 "
            "gf cm^2/cm), typical extension at 490 N/m 4 to 12 %; shear 0.5 to 2 gf/cm a degree"),
      woven("silk", 0.06f, 0.0002f, 12000, 8000, 0.35f, 2.5e-6f, 0.3f, 0.2f,
            "typical of light plain-woven silk: KES-F bending 0.01 to 0.06 gf cm^2/cm, extension at 490 N/m 2 to 6 %"),
      woven("denim", 0.4f, 0.0009f, 15000, 10000, 2.2f, 6e-5f, 0.5f, 0.4f,
            "400 g/m^2 cotton denim: bending for the measured drape coefficient of twill 3/1, 80 % (KES-F: 0.61 gf "
            "cm^2/cm), typical extension at 490 N/m 2 to 6 %"),
      woven("wool", 0.2f, 0.0005f, 6000, 4000, 0.65f, 1.2e-5f, 0.45f, 0.35f,
            "typical of worsted suiting: KES-F bending 0.06 to 0.25 gf cm^2/cm, extension at 490 N/m 4 to 12 %"),
      sheet("leather", 650, 0.0009, 1e7, 0.4, 0.1f, 0.6f, 0.5f,
            "a homogeneous sheet with E = 10 MPa, typical of soft chrome-tanned garment leather (5 to 30 MPa at small "
            "strain), "
            "Poisson's ratio 0.4, 650 kg/m^3, 0.9 mm"),
      sheet("rubber sheet", 950, 0.001, 1.5e6, 0.5, 0.03f, 0.9f, 0.8f,
            "a homogeneous sheet with E = 1.5 MPa, typical of soft natural rubber (1 to 2 MPa at small strain), "
            "incompressible, "
            "950 kg/m^3, 1 mm"),
  };
}

}  // namespace

const std::vector<Fabric>& fabrics() {
  static const std::vector<Fabric> all = make_fabrics();
  return all;
}

const Fabric& fabric(std::string_view name) { return preset_named(fabrics(), name, "there is no fabric", "a Fabric"); }

}  // namespace pliant
