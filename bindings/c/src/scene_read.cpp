// Scenes: what they hold, as facts, findings and text.
#include "memory.h"
#include "pliant/describe.h"
#include "scene_handle.h"

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_scene_get_info(const pliant_scene* scene, pliant_scene_info* info) {
  return guarded([&] {
    const auto handle = at(scene);
    const Scene& of = handle->scene;
    pliant_scene_info facts{};
    facts.frame_time = of.frame_time;
    facts.frames = of.frames;
    facts.objects = static_cast<std::int64_t>(of.objects.size());
    facts.colliders = static_cast<std::int64_t>(of.colliders.size());
    facts.mesh_colliders = static_cast<std::int64_t>(of.mesh_colliders.size());
    for (const Object& object : of.objects) facts.particles += static_cast<std::int64_t>(object.positions.size());
    give(facts, info, "info");
  });
}

pliant_status pliant_scene_check(pliant_scene* scene, size_t* findings, size_t* grave) {
  return guarded([&] {
    const auto of = at(scene);
    std::vector<Finding> found = inspect(of->scene);
    found.reserve(found.size() + of->notes.size());
    for (const std::string& note : of->notes) found.push_back({false, note, {}});
    of->findings = std::move(found);
    if (findings != nullptr) *findings = of->findings.size();
    if (grave == nullptr) return;
    const auto is_grave = [](const Finding& finding) { return finding.grave; };
    *grave = static_cast<size_t>(std::count_if(of->findings.begin(), of->findings.end(), is_grave));
  });
}

pliant_status pliant_scene_get_finding(const pliant_scene* scene, size_t index, pliant_finding* finding) {
  return guarded([&] {
    const auto of = at(scene);
    require(finding, "finding");
    if (index >= of->findings.size())
      throw StatusError(PLIANT_NOT_FOUND,
                        "there is no finding " + std::to_string(index) + " of " + std::to_string(of->findings.size()),
                        "call pliant_scene_check first, and count from 0");
    const Finding& found = of->findings[index];
    pliant_finding facts{};
    facts.is_grave = found.grave ? 1 : 0;
    facts.message = found.message.c_str();
    facts.advice = found.advice.c_str();
    give(facts, finding, "finding");
  });
}

pliant_status pliant_scene_json(const pliant_scene* scene, char* into, size_t capacity, size_t* length) {
  return guarded([&] { give_text(scene_json(at(scene)->scene), {into, capacity, length}); });
}

pliant_status pliant_scene_describe(const pliant_scene* scene, char* into, size_t capacity, size_t* length) {
  return guarded([&] { give_text(describe(at(scene)->scene), {into, capacity, length}); });
}
