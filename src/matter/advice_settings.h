// Chooses settings to recommend for a scene, and formats them for a scene file.
#pragma once

#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// True if tethers may help: an object hangs from pins, and all such objects are rigid. Tethers limit inextensible objects;
/// they would restrain those that are meant to stretch.
bool may_tether(const Scene& scene);

/// Other sweeps that may need less time for the same stretch, the one that measured best on such scenes first (see
/// suggest), because there may be time for only one.
std::vector<Sweep> better_sweeps(const Scene& scene);

/// The scene's settings with the sweep and tethers that measured best on such
/// scenes (docs/internals/convergence.md), or its own if that is the default.
Settings suggest(const Scene& scene);
/// The same with `settings` instead of the scene's own.
Settings suggest(const Scene& scene, const Settings& settings);
/// As chosen_sweep in pliant/scene.h, with `settings` instead of the scene's own.
Sweep chosen_sweep(const Scene& scene, const Settings& settings, int object, std::string* reason = nullptr);
/// The same of all objects at once.
std::vector<Sweep> chosen_sweeps(const Scene& scene, const Settings& settings);

/// True if a sheet supports itself; multigrid, which ignores bending, would make it oscillate.
bool has_stiff_sheet(const Scene& scene);

/// The JSON of a scene's "settings" (substeps, sweep, tethers) that changes `own` into `wanted`:
/// {"substeps": 10, "sweep": "chains", "sweep_options": {"tethers": true}}.
std::string in_json(const Settings& wanted, const Settings& own);

}  // namespace pliant
