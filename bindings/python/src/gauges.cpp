// pliant.Gauges: reads the gauges of a scene.

#include "pliant/gauges.h"

#include <algorithm>
#include <string_view>

#include "pliant/error.h"
#include "world.h"

namespace pliant::python {

namespace {

struct GaugesRef {
  SharedWorld world;
  Gauges gauges;
};

GaugesRef gauges_of(const WorldRef& self) {
  World& world = self.world->idle();
  const std::vector<Gauge>& of_scene = self.world->file().gauges;
  if (of_scene.empty())
    throw Error({.element = "/gauges"}, "the scene has no gauges",
                "add \"gauges\" to the scene before the World is made");
  GaugesRef made{self.world, Gauges(of_scene, self.world->present(), world)};
  const auto measures_force = [](const Gauge& gauge) { return std::string_view(unit_of(gauge)) == "N"; };
  if (std::any_of(made.gauges.gauges().begin(), made.gauges.gauges().end(), measures_force))
    self.world->records_contacts = true;  // by the Gauges
  return made;
}

nb::dict read(GaugesRef& self) {
  const std::vector<double> values = self.gauges.read(self.world->idle());
  nb::dict dict;
  for (std::size_t i = 0; i < values.size(); ++i) dict[self.gauges.gauges()[i].name.c_str()] = values[i];
  return dict;
}

nb::dict units(const GaugesRef& self) {
  nb::dict dict;
  for (const Gauge& gauge : self.gauges.gauges()) dict[gauge.name.c_str()] = unit_of(gauge);
  return dict;
}

}  // namespace

void bind_gauges(nb::module_& m) {
  nb::class_<GaugesRef>(
      m, "Gauges", nb::type_slots(collected_slots<GaugesRef>()),
      "Reads the gauges of a World's scene (\"gauges\" of the scene format): World.gauges() returns it. Flow and force "
      "are means since the last read().")
      .def("read", &read, nb::sig("def read(self) -> dict[str, float]"),
           "The value of each gauge by name. Call it once for the initial state and once after each step. A value is "
           "nan where there is none: flow and force in the first call.")
      .def_prop_ro("units", &units, nb::sig("def units(self) -> dict[str, str]"),
                   "The unit of each gauge by name: \"m\", \"m^3/s\" or \"N\".")
      .def("__repr__", [](const GaugesRef& g) {
        return "<pliant.Gauges: " + std::to_string(g.gauges.gauges().size()) + " gauges>";
      });
}

void bind_gauge_reading(nb::class_<WorldRef>& c) {
  c.def("gauges", &gauges_of, nb::sig("def gauges(self) -> Gauges"),
        "A reader of the scene's gauges. Starts the recording of contact events where a gauge measures a force. Raises "
        "Error if the scene has no gauges, or what one measures was removed. Gauges are not in a saved or pickled "
        "World.");
}

}  // namespace pliant::python
