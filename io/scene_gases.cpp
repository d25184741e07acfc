// Builds gases and tracers in scene files.
#include "pliant/gas.h"
#include "scene_build.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

Region region_of(const JsonValue& at) {
  Region region;
  if (const JsonValue* ball = at.find("ball")) {
    set(*ball, "centre", region.centre);
    set(*ball, "radius", region.radius);
    return region;
  }
  const JsonValue& box = *at.find("box");
  const Vec3f low = vector_of(*box.find("min")), high = vector_of(*box.find("max"));
  region.centre = (low + high) * 0.5f;
  region.half_size = (high - low) * 0.5f;
  return region;
}

}  // namespace

BuiltObject gas_of(const JsonDocument& document, const JsonValue& at, const std::string& name, const MeshFolder& folder,
                   std::vector<std::string>& repairs) {
  GasOptions options;
  if (std::string preset; set(at, "preset", preset)) options = gas_preset(preset);
  options.name = name;
  set(at, "spacing", options.fluid.spacing);
  set(at, "density", options.fluid.density);
  set(at, "speed_of_sound", options.fluid.speed_of_sound);
  set(at, "temperature", options.gas.temperature);
  set(at, "ambient_temperature", options.gas.ambient_temperature);
  set(at, "ambient_density", options.gas.ambient_density);
  set(at, "cooling_time", options.gas.cooling_time);
  set(at, "diffusivity", options.gas.diffusivity);
  set(at, "drag", options.gas.drag);
  set(at, "vorticity", options.gas.vorticity);
  for (const JsonValue& item : elements(at, "heaters")) {
    GasHeater& heater = options.gas.heaters.emplace_back();
    heater.region = region_of(*item.find("region"));
    set(item, "temperature", heater.temperature);
    set(item, "rate", heater.rate);
  }
  return {make_gas(places_of({document, folder, name, repairs, options.fluid.spacing}, at), options)};
}

BuiltObject tracers_of(const JsonValue& at, const std::string& name) {
  TracersOptions options;
  options.name = name;
  options.tracers.source = region_of(*at.find("source"));
  set(at, "capacity", options.capacity);
  set(at, "rate", options.tracers.rate);
  set(at, "lifetime", options.tracers.lifetime);
  set(at, "start", options.tracers.start);
  set(at, "end", options.tracers.end);
  set(at, "radius", options.tracers.radius);
  set(at, "opacity", options.tracers.opacity);
  return {make_tracers(options)};
}

}  // namespace pliant::scene_file
