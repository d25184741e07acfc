// Chooses settings to recommend for a scene, and formats them for a scene file.
#pragma once

#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// True if tethers may help: some object with lengths hangs from pins, and all objects that hang are rigid. Tethers
/// limit the length of inextensible objects; they would hold back objects that are meant to stretch, and soft bodies.
bool may_tether(const Scene& scene);

/// Other sweeps that may need less time for the same stretch. The default for the scene comes first, because there may
/// be time to try only one. Multigrid is left out where the choice leaves it out: cloth sticks to colliders by it.
/// There are none where a soft body has no lengths, because these sweeps correct lengths alone.
std::vector<Sweep> better_sweeps(const Scene& scene);

/// The settings with sweep, substeps and their bounds left open, so that the default is used.
Settings left_open(Settings settings);
/// The members of settings by which they depart from the default for the scene, as a scene file has them: "\"sweep\"
/// and
/// \"substeps\"". Empty if they do not depart. `chosen` are those that chosen_settings returns for them.
std::string departures(const Scene& scene, const Settings& given, const Settings& chosen);
/// Like chosen_settings in pliant/scene.h, with `settings` instead of the scene's own.
Settings chosen_settings(const Scene& scene, Settings settings, std::string* reason = nullptr);
/// Like chosen_substeps in pliant/scene.h, with `settings` instead of the scene's own.
std::vector<int> chosen_substeps(const Scene& scene, const Settings& settings);
/// Like chosen_sweep in pliant/scene.h, with `settings` instead of the scene's own.
Sweep chosen_sweep(const Scene& scene, const Settings& settings, int object, std::string* reason = nullptr);
/// The sweeps of all objects, as chosen_sweep returns them.
std::vector<Sweep> chosen_sweeps(const Scene& scene, const Settings& settings);

/// True if an object with so many linked particles is too small for sweeps to differ; it follows the others.
bool is_coarse(std::size_t particles);

/// True if the scene has a sheet that supports itself. Multigrid ignores bending and would make it oscillate.
bool has_stiff_sheet(const Scene& scene);

/// The JSON of a scene's "settings" (substeps or their bounds, sweep, tethers) that changes `own` into `wanted`:
/// {"substeps": 10, "sweep": "chains", "sweep_options": {"tethers": true}}.
std::string in_json(const Settings& wanted, const Settings& own);

}  // namespace pliant
