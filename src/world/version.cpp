#include "pliant/version.h"

namespace pliant {

std::string version() { return PLIANT_VERSION; }

}  // namespace pliant
