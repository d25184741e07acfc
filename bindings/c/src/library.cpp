// The library itself: its version, its format and its materials.
#include "memory.h"
#include "pliant/grains.h"
#include "pliant/io.h"
#include "pliant/liquid.h"
#include "pliant/rod.h"
#include "pliant/version.h"

namespace pliant::c {

namespace {

/// A string of JSON. Built-in names and sources hold printable ASCII.
std::string quoted(const std::string& text) {
  std::string made = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') made += '\\';
    made += c;
  }
  return made + '"';
}

template <class Kinds>
std::string list_of(const char* name, const Kinds& kinds) {
  std::string made = quoted(name) + ": [";
  for (const auto& kind : kinds) {
    if (&kind != &kinds.front()) made += ", ";
    made += "{\"name\": " + quoted(kind.name) + ", \"source\": " + quoted(kind.source) + "}";
  }
  return made + "]";
}

}  // namespace

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

const char* pliant_version(void) {
  static const std::string text = version();
  return text.c_str();
}

pliant_status pliant_schema(char* into, size_t capacity, size_t* length) {
  return guarded([&] { give_text(scene_schema(), {into, capacity, length}); });
}

pliant_status pliant_materials(char* into, size_t capacity, size_t* length) {
  return guarded([&] {
    give_text("{" + list_of("fabrics", fabrics()) + ", " + list_of("liquids", liquids()) + ", " +
                  list_of("grains", grain_kinds()) + ", " + list_of("solids", elastic_solids()) + ", " +
                  list_of("rods", rod_materials()) + "}",
              {into, capacity, length});
  });
}
