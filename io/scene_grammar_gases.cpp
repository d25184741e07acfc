// The table of the scene format: gases and tracers.
#include "pliant/gas.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

constexpr double hottest = 1e9;  // [K]

const Record& region_ball_record() {
  static const Record result{
      "ball",
      "A ball in space.",
      {needed("centre", place(), "Its centre."), needed("radius", positive("m", largest_place), "Its radius.")},
      {}};
  return result;
}

const Record& region_box_record() {
  static const Record result{"region box",
                             "An axis-aligned box in space.",
                             {needed("min", place(), "Its low corner."), needed("max", place(), "Its high corner.")},
                             {}};
  return result;
}

const Record& region_record() {
  static const Record result{"region",
                             "A part of space.",
                             {either("box", record(region_box_record()), "An axis-aligned box."),
                              either("ball", record(region_ball_record()), "A ball.")},
                             {"box", "ball"}};
  return result;
}

const Record& heater_record() {
  static const Record result{"heater",
                             "Heats or cools the gas in a region: dT/dt = rate (temperature - T).",
                             {needed("region", record(region_record()), "Where it heats."),
                              needed("temperature", positive("K", hottest), "What the gas is heated to."),
                              field("rate", number("1/s", 0), GasHeater{}.rate, "How fast.")},
                             {}};
  return result;
}

}  // namespace

const Record& gas_record() {
  static const Record result{
      "gas",
      "A gas of particles, surrounded by air that bears it up. Gases with the same spacing, speed of sound, groups and "
      "mask mix.",
      {either("fill", record(fill_record()), "The box that it fills at the start."),
       either("positions", places(), "Positions of the particles at the start, about a spacing apart."),
       field("preset", choice({"air", "smoke", "helium"}), "none",
             "Density and diffusivity of a gas, surrounded by air; smoke is air at 400 K."),
       field("spacing", positive("m", largest_place), GasOptions{}.fluid.spacing, "Distance of particles at rest."),
       field("density", positive("kg/m^3"), "that of the preset, else 1.2",
             "Density at rest, at the ambient temperature."),
       field("speed_of_sound", number("m/s", 0, largest_velocity), GasOptions{}.fluid.speed_of_sound,
             "By which it yields to a pressure p: by p / (density c^2). 0: it does not yield."),
       field("temperature", positive("K", hottest), "that of the preset, else 293.15", "Temperature at the start."),
       field("ambient_temperature", positive("K", hottest), Gas{}.ambient_temperature,
             "Temperature of the air around."),
       field("ambient_density", number("kg/m^3", 0), "1.204 with a preset, else 1.2",
             "Density of the air around: the gas is accelerated by -g (ambient_density / density T / "
             "ambient_temperature - "
             "1)."),
       field("cooling_time", number("s", 0), Gas{}.cooling_time,
             "Time constant with which it cools to the ambient temperature; 0: it does not."),
       field("diffusivity", number("m^2/s", 0), "that of the preset, else 0", "Diffusivity of heat."),
       field("drag", number("1/s", 0), Gas{}.drag,
             "Rate at which the wind's velocity is taken by particles without neighbours; others in proportion to the "
             "density "
             "that is missing."),
       field("vorticity", number("m/s", 0), Gas{}.vorticity, "Coefficient of vorticity confinement."),
       field("heaters", list(record(heater_record())), "none", "Regions in which it is heated.")},
      {"fill", "positions"}};
  return result;
}

const Record& tracers_record() {
  static const Record result{
      "tracers",
      "Points without weight that gases carry along. They are emitted from a region, and vanish after a lifetime.",
      {needed("source", record(region_record()), "Where they are emitted."),
       field("capacity", integer(1, 1 << 24), TracersOptions{}.capacity,
             "Most tracers at a time; a new one then replaces the oldest."),
       field("rate", positive("1/s", 1e9), Tracers{}.rate, "Tracers emitted in a second."),
       field("lifetime", positive("s", 1e9), Tracers{}.lifetime, "After which each vanishes."),
       field("start", number("s", -1e9, 1e9), Tracers{}.start, "Time of the first one."),
       field("end", number("s", -1e9, 1e9), Tracers{}.end, "Time of the last one; 0: never."),
       field("radius", positive("m", largest_place), Tracers{}.radius, "Of a puff in pictures."),
       field("opacity", number("-", 0, 0.999), Tracers{}.opacity,
             "Of a puff in pictures: how much of the light through its middle it takes.")},
      {}};
  return result;
}

}  // namespace pliant::scene_file
