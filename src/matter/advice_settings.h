// Which settings are worth advising for a scene, and how a scene file writes them.
#pragma once

#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Whether tethers may help: something hangs from pins, and all that does is rigid. Tethers bound what is inextensible; what
/// is meant to stretch they would hold back.
bool may_tether(const Scene& scene);

/// Sweeps other than the scene's own that may need less time for the same stretch, the one that measured best on scenes of its
/// kind first (see suggest): there may be time for one alone.
std::vector<Sweep> better_sweeps(const Scene& scene);

/// The scene's settings with the sweep, and tethers, that measured best on scenes of its kind (docs/internals/convergence.md); its own
/// where that is none but the default.
Settings suggest(const Scene& scene);
/// The same with other settings than the scene's own.
Settings suggest(const Scene& scene, const Settings& settings);
/// As chosen_sweep in pliant/scene.h, with other settings than the scene's own.
Sweep chosen_sweep(const Scene& scene, const Settings& settings, int object, std::string* reason = nullptr);

/// Whether a sheet holds itself up, so that multigrid, which knows no bending, would make it rattle.
bool has_stiff_sheet(const Scene& scene);

/// What a scene's "settings" must say so that `own` becomes `wanted`, of substeps, sweep and tethers, as JSON:
/// {"substeps": 10, "sweep": "chains", "sweep_options": {"tethers": true}}.
std::string in_json(const Settings& wanted, const Settings& own);

}  // namespace pliant
