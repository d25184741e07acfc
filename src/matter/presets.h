// Looks up built-in materials by name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pliant/error.h"

namespace pliant {

/// The preset of this name. `missing` begins the message if there is none, as "there is no fabric"; `type` is what can
/// be filled in instead, with its article. Throws an Error that lists the names.
template <class Preset>
const Preset& preset_named(const std::vector<Preset>& all, std::string_view name, const char* missing,
                           const char* type) {
  std::string names;
  for (const Preset& each : all) {
    if (each.name == name) return each;
    names += (names.empty() ? "" : ", ") + each.name;
  }
  throw Error({}, std::string(missing) + " '" + std::string(name) + "'",
              "choose one of " + names + ", or fill in " + type);
}

}  // namespace pliant
