// The version of these headers, and of the library that is linked.
#pragma once

#include <string>

#define PLIANT_VERSION_MAJOR 0
#define PLIANT_VERSION_MINOR 1
#define PLIANT_VERSION_PATCH 0
/// The version as text. CMakeLists.txt reads it here.
#define PLIANT_VERSION "0.1.0"

namespace pliant {

/// The version of the library that is linked, as "0.1.0": equal to PLIANT_VERSION, unless headers and library differ.
std::string version();

}  // namespace pliant
