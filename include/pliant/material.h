// Stiffness as XPBD compliance or PBD k, and fabrics in SI units.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

/// How strongly a constraint is enforced: by compliance, or by stiffness k.
///
/// Compliance (XPBD; Macklin, Mueller and Chentanez 2016): the inverse stiffness alpha in the unit of the constraint
/// type (m/N for a distance); 0 is rigid. It is independent of time step, substeps and iterations. Stiffness k (PBD;
/// Mueller et al. 2007): the share in [0, 1] of the error that a step removes, distributed over projections by k' = 1 -
/// (1 - k)^(1/n). It depends on the time step, so prefer compliance.
struct Stiffness {
  enum class Kind { compliance, pbd };
  Kind kind = Kind::compliance;
  float value = 0;  ///< compliance alpha >= 0, or k in [0, 1]
  /// Damping beta >= 0 of a compliance [N s/m for a distance] (eq. 26): a time alpha beta below a substep acts as one.
  float damping = 0;

  static Stiffness rigid() { return {}; }
  static Stiffness compliance(float alpha, float beta = 0) { return {Kind::compliance, alpha, beta}; }
  static Stiffness pbd(float k) { return {Kind::pbd, k, 0}; }
};

/// What a conversion between k and compliance depends on.
struct ConversionContext {
  /// Generalised: sum of w_i |grad_i C|^2 over all particles; 2/m for a distance of masses m [1/kg]
  float inverse_mass;
  float dt;  ///< time step of a frame [s]
  int substeps = 1;
  int iterations = 1;
};

/// The compliance that removes the same share of an isolated constraint's error per frame as PBD stiffness k: alpha =
/// h^2 w (1 - k') / k', with h = dt/substeps and k' = 1 - (1 - k)^(1/substeps). It does not depend on iterations. k = 0
/// gives infinity, k = 1 gives 0. Throws an Error if k is not in [0, 1].
float compliance_from_stiffness(float k, const ConversionContext& context);

/// The PBD stiffness k that corresponds to compliance alpha. Throws an Error if alpha < 0.
float stiffness_from_compliance(float alpha, const ConversionContext& context);

/// Makes the particles of an object a liquid: a constraint on the density at each of them (Macklin and Mueller 2013).
/// Liquids with the same spacing, speed of sound, groups and mask mix; others do not meet.
struct Fluid {
  float spacing = 0.02f;      ///< distance of particles at rest [m]
  float density = 1000;       ///< at rest [kg/m^3]
  float speed_of_sound = 0;   ///< by which it yields to pressure p: by p / (density c^2); 0: it does not yield [m/s]
  float viscosity = 0;        ///< dynamic: water 0.001, honey 10; 0: none; at most 1e6 [Pa s]
  float surface_tension = 0;  ///< towards air: water 0.072; 0: none; at most 1e6 [N/m]
  /// On colliders and rigid bodies, measured through the liquid: Young's law, with `surface_tension`. Water on clean
  /// glass has 20 or less, on paraffin wax 105 to 110; 180: no adhesion, so that the liquid beads [degrees]
  float contact_angle = 180;
  /// Confinement: accelerates by this times N x omega (Macklin and Mueller 2013, eq. 15 and 16), so that swirls last;
  /// 0: none, at most 1e6 [m/s]. A gas has Gas::vorticity instead.
  float vorticity = 0;
  /// In pictures: the way in the liquid that leaves a third of the light that is not of its colour; water some metres,
  /// honey two centimetres. 0: by the size of what the picture shows [m]
  float clarity = 0;
};

/// Makes the particles of an object grains: spheres that press on one another with friction, and do not turn. Grains
/// whose objects meet by groups and masks touch, also of different radius.
struct Grains {
  float radius = 0.01f;   ///< of each sphere [m]
  float density = 2650;   ///< of the solid, not of the bulk with its voids [kg/m^3]
  float friction = 0.6f;  ///< of the bulk: tangent of the angle of repose [-]
  /// Of the bulk: the tensile stress at which it parts; wet sand some 1000 [Pa]. A contact of two grains of diameter d
  /// bears a pull of 0.87 d^2 times this (Rumpf 1962, for 0.6 of the volume filled and six contacts a grain). Grains do
  /// not stick to anything else.
  float cohesion = 0;
  /// By how much a grain counts as lighter the higher it lies, in contacts with others: masses times exp(-mass_scaling
  /// * height). High piles then need fewer substeps (Macklin et al. 2014, section 5.2), but momentum is lost and heavy
  /// things sink less. 0: off; at most 1000 [1/m]
  float mass_scaling = 0;
};

/// How a surface takes up liquid: what touches it soaks in, spreads along it, makes it heavier, and drips off where it
/// collects. The mass of liquid at each particle is in the channel "water" of the State [kg]. All liquids count that
/// meet the object by groups and masks: their particles go as they soak in, and come again as drops.
/// docs/guide/wet_cloth.md explains it.
struct Absorbency {
  float capacity = 0.5f;  ///< most liquid that it holds against gravity, > 0 [kg/m^2]
  /// Speed at which liquid that touches it soaks in while it is not full; 0: it repels liquid [m/s]
  float uptake = 0.1f;
  float wicking = 1e-4f;  ///< diffusivity of the liquid along it; 0: the liquid stays where it is [m^2/s]
  float rise = 0.3f;      ///< how high it draws liquid up against gravity, > 0 [m]
  /// Speed at which what is more than `capacity` runs down it, to where it drips off; 0: it stays [m/s]
  float runoff = 0.05f;
  float seepage = 0;  ///< speed at which liquid that lies on it passes through where it is full; 0: it is tight [m/s]
  float drag = 0;     ///< rate at which liquid that touches it takes on its velocity, and the reverse [1/s]
};

/// An axis-aligned box, or a ball.
struct Region {
  Vec3f centre{};     ///< [m]
  Vec3f half_size{};  ///< of a box, along each axis [m]
  float radius = 0;   ///< above 0: a ball, and `half_size` has no effect [m]
};

/// Heats the gas in a region, in proportion to what is missing: dT/dt = rate (temperature - T).
struct GasHeater {
  Region region{};
  float temperature = 500;  ///< [K]
  float rate = 10;          ///< [1/s]
};

/// Makes a liquid (Fluid) a gas that air surrounds: it has a temperature, and the air bears it up. The temperature of
/// each particle is in the channel "temperature" of the State [K]. Boussinesq: temperature changes weight and not
/// volume.
struct Gas {
  float temperature = 293.15f;  ///< at the start [K]
  /// Of the air around; Fluid::density is that of the gas at this temperature [K]
  float ambient_temperature = 293.15f;
  /// Of the air around; the gas is accelerated by -g (ambient_density / density T / ambient_temperature - 1) [kg/m^3].
  float ambient_density = 1.2f;
  float cooling_time = 0;  ///< time constant of cooling to the ambient temperature; 0: none [s]
  float diffusivity = 0;   ///< of heat [m^2/s]
  /// Of the air on the surface: 1/time in which a particle without neighbours takes its velocity [1/s]
  float drag = 0;
  float vorticity = 0;  ///< confinement: accelerates by this times N x omega (Steinhoff and Underhill 1994) [m/s]
  std::vector<GasHeater> heaters{};
};

/// Makes the particles of an object tracers: points without weight that the gas carries along, as smoke. They are
/// emitted from a region at a rate, and vanish after a lifetime. The age of each is in the channel "age" of the State
/// [s]; below 0 it is not there.
struct Tracers {
  Region source{};
  float rate = 1000;         ///< [1/s]
  float lifetime = 4;        ///< [s]
  float start = 0, end = 0;  ///< of emission; an end of 0 is never [s]
  float radius = 0.03f;      ///< of a puff in pictures [m]
  float opacity = 0.5f;      ///< of a puff in pictures: how much of the light through its middle it takes [0..1)
};

/// Properties of a fabric. They do not depend on a mesh.
struct Fabric {
  std::string name;
  float area_density = 0.15f;       ///< mass per area [kg/m^2]
  float thickness = 0.0004f;        ///< thickness [m]; two layers keep this distance
  float stretch_stiffness = 2000;   ///< membrane stiffness, force per width and strain [N/m]; infinity: inextensible
  float bending_stiffness = 1e-5f;  ///< flexural rigidity per width [N m]
  float bending_damping = 0;        ///< fraction of critical damping of bending, 0..1 [-]
  float static_friction = 0.4f;     ///< coefficient of friction at rest [-]
  float kinetic_friction = 0.3f;    ///< coefficient of friction while sliding [-]
  std::string source;               ///< where the numbers come from
  float weft_stiffness = 0;   ///< of woven cloth across the warp, >= 0; 0: that of the warp, `stretch_stiffness` [N/m]
  float shear_stiffness = 0;  ///< of woven cloth: shear force per width and angle; 0: `stretch_stiffness` / 100 [N/m]
};

/// Returns a built-in fabric: "cotton", "silk", "denim", "wool", "leather" or "rubber sheet". For any other name throws
/// an Error that lists the names.
const Fabric& fabric(std::string_view name);

/// All built-in fabrics.
const std::vector<Fabric>& fabrics();

}  // namespace pliant
