// Builds what holds an object's particles: pins, attachments, and the parts that are tied to its bodies.
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/cluster.h"
#include "pliant/stitch.h"
#include "scene_build.h"
#include "scene_hints.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

std::vector<int> all_particles(const Object& object) {
  std::vector<int> all(object.positions.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

void set_pins(const JsonDocument& document, const JsonValue& at, BuiltObject& built) {
  std::vector<bool> taken(built.object.positions.size(), false);
  for (const JsonValue& item : elements(at, "pins")) {
    Pin pin;
    set(document, item, "motion", pin.motion);
    const JsonValue& particles = *item.find("particles");
    for (const int particle : selected(document, particles, built)) {
      if (taken[static_cast<std::size_t>(particle)])
        document.fail(particles, "particle " + std::to_string(particle) + " is already pinned", "pin it once");
      taken[static_cast<std::size_t>(particle)] = true;
      pin.particle = particle;
      built.object.pins.push_back(pin);
    }
  }
}

namespace {

/// Does what may throw an Error without a file, which then gets the place of a JSON value.
template <class Action>
void located(const JsonDocument& document, const JsonValue& item, const BuiltObject& built, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    if (!error.where().file.empty()) throw;
    Location place = document.locate(item);
    place.object = built.object.name;
    place.element += ", " + error.where().element;
    throw Error(place, error.problem(), error.advice());
  }
}

}  // namespace

void set_clusters(const JsonDocument& document, const JsonValue& at, BuiltObject& built) {
  for (const JsonValue& item : elements(at, "clusters")) {
    ClusterOptions options;
    std::string mode;
    set(item, "mode", mode);
    if (mode == "linear") options.mode = Cluster::Mode::linear;
    if (mode == "quadratic") options.mode = Cluster::Mode::quadratic;
    set(item, "share", options.share);
    set(document, item, "stiffness", options.stiffness);
    set(item, "plasticity", options.plasticity);
    const JsonValue *particles = item.find("particles"), *size = item.find("size");
    if (particles != nullptr && size != nullptr)
      document.fail_key(*size, "clusters of a size are of all particles", "give `particles` or `size`");
    located(document, item, built, [&] {
      if (size != nullptr) {
        add_clusters(built.object, static_cast<float>(size->number), options);
      } else if (particles != nullptr) {
        add_cluster(built.object, selected(document, *particles, built), options);
      } else {
        add_cluster(built.object, all_particles(built.object), options);
      }
    });
  }
}

void set_stitches(const JsonDocument& document, const JsonValue& at, BuiltObject& built) {
  for (const JsonValue& item : elements(at, "stitches")) {
    StitchOptions options;
    set(item, "closing_time", options.closing_time);
    set(document, item, "stiffness", options.stiffness);
    set(item, "break_force", options.break_force);
    const std::vector<int> particles = selected(document, *item.find("particles"), built),
                           to = selected(document, *item.find("to"), built);
    for (const int particle : to)
      if (std::find(particles.begin(), particles.end(), particle) != particles.end() && to.size() > 1)
        document.fail_key(*item.find("to"), "particle " + std::to_string(particle) + " is on both sides of the seam",
                          "select the two borders that are to meet");
    const bool yields = options.stiffness.kind == Stiffness::Kind::compliance && options.stiffness.value > 0;
    if (options.break_force > 0 && !yields)
      document.fail_key(*item.find("break_force"), "a thread without a compliance tells no force at which to break",
                        "give it a `stiffness` of {\"compliance\": 1e-5} m/N or more");
    located(document, item, built,
            [&] { add_stitches(built.object, nearest_pairs(built.object, particles, to), options); });
  }
}

void set_attachments(const JsonDocument& document, const JsonValue& at, BuiltObject& built) {
  for (const JsonValue& item : elements(at, "attachments")) {
    Attachment attachment;
    set(document, item, "motion", attachment.motion);
    set(document, item, "stiffness", attachment.stiffness);
    const bool one_target = set(item, "target", attachment.target);
    for (const int particle : selected(document, *item.find("particles"), built)) {
      attachment.particle = particle;
      if (!one_target) attachment.target = built.object.positions[static_cast<std::size_t>(particle)];
      built.object.attachments.push_back(attachment);
    }
  }
}

int body_named(const JsonDocument& document, const JsonValue& at, const Object& object) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < object.bodies.size(); ++i) {
    if (object.bodies[i].name == at.text) return static_cast<int>(i);
    names.push_back(object.bodies[i].name);
  }
  const std::string near = nearest_name(at.text, names);
  document.fail(at, "the object has no body '" + printable(at.text) + "'",
                near.empty() ? "name one of its bodies" : "did you mean '" + printable(near) + "'?");
}

namespace {

void set_ties(const JsonDocument& document, const JsonValue& at, const BuiltObject& part, int first, Object& object) {
  for (const JsonValue& item : elements(at, "ties")) {
    Stiffness stiffness;
    set(document, item, "stiffness", stiffness);
    std::vector<int> particles = selected(document, *item.find("particles"), part);
    for (int& particle : particles) particle += first;
    attach(object, particles, body_named(document, *item.find("body"), object), stiffness);
  }
}

const JsonValue& matter_of(const JsonValue& part) {
  for (const char* kind : {"cloth", "soft_body", "rope"})
    if (const JsonValue* found = part.find(kind)) return *found;
  return *part.find("particles");
}

}  // namespace

void add_parts(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder, Object& object,
               std::vector<std::string>& repairs) {
  const JsonValue* list = at.find("parts");
  if (list == nullptr) return;
  if (object.bodies.empty())
    document.fail_key(*list, "only an object of bodies has parts", "make the part an object of its own");
  for (const JsonValue& item : list->items) {
    if (const JsonValue* rod = item.find("rod")) {
      for (const char* only : {"ties", "pins", "attachments"})
        if (const JsonValue* given = item.find(only))
          document.fail_key(*given, "a rod has no particles of its own", "hold it by its `start` and `end`");
      add_rod_part(document, *rod, object);
      continue;
    }
    const JsonValue& what = matter_of(item);
    if (const JsonValue* volume = what.find("volume"))
      document.fail_key(*volume, "a part has no volume constraint", "make the balloon an object of its own");
    BuiltObject part = build_matter(document, what, object.name, folder, repairs);
    set_pins(document, item, part);
    set_attachments(document, item, part);
    const int first = append(object, part.object);
    set_ties(document, item, part, first, object);
  }
}

}  // namespace pliant::scene_file
