// Scenes whose sag at rest is known, for the table of scene_table.h (`pliant bench default` without scenes).
#pragma once

#include <vector>

#include "apps/bench/scene_table.h"

namespace pliant::bench {

/// A cantilever of cotton, woven sheets that hang by an edge and by a side, and a soft bar: each with what its free end
/// sags over the right sag (NamedScene::yield). Sweep and substeps are left open.
std::vector<NamedScene> known_sags();

}  // namespace pliant::bench
