#include "solver/divide.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "math/vector.h"

namespace pliant {

namespace {

/// Upper limit of a collider's displacement per substep, as a share of the thickness of a pair.
constexpr double displacement_over_thickness = 0.5;

bool come_near(const CarrierBox& a, const CarrierBox& b, double margin) {
  const Vec3d apart = max(a.low - b.high, b.low - a.high);
  return max(max(apart.x, apart.y), apart.z) <= margin;
}

CarrierBox joined(const CarrierBox& a, const CarrierBox& b) { return {min(a.low, b.low), max(a.high, b.high)}; }

/// The box that a collider sweeps in the frame, and its largest displacement in a planned substep [m].
struct Swept {
  CarrierBox box{};
  double largest = 0;
};

Swept swept(const Carrier& carrier, const PlannedFrame& frame) {
  Swept out{box_at(carrier, frame.start), 0};
  for (int substep = 0; substep < frame.substeps; ++substep) {
    const double from = frame.start + frame.dt * substep / frame.substeps,
                 to = frame.start + frame.dt * (substep + 1) / frame.substeps;
    out.box = joined(out.box, box_at(carrier, to));
    out.largest = std::max(out.largest, largest_move(carrier, from, to));
  }
  return out;
}

void follow(const Vec3d& from, const Vec3d& to, Swept& out) {
  out.box = joined(out.box, {min(from, to), max(from, to)});
  out.largest = std::max(out.largest, static_cast<double>(length(to - from)));
}

/// The swept box and largest displacement of a collider that the user moves to a pose.
Swept swept(const Carrier& carrier, const PoseDrive& drive, const PlannedFrame& frame) {
  Swept out{{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}}, 0};
  for (int substep = 0; substep < frame.substeps; ++substep) {
    const double from = frame.start + frame.dt * substep / frame.substeps,
                 to = frame.start + frame.dt * (substep + 1) / frame.substeps;
    const CarrierPose before(carrier, from, drive.at(from)), after(carrier, to, drive.at(to));
    for (int i = 0; i < static_cast<int>(carrier.rest.size()); ++i) follow(before.place(i), after.place(i), out);
  }
  return out;
}

/// The swept box and largest displacement of a collider whose vertices the user moves.
Swept swept(const std::vector<Target>& targets, const PlannedFrame& frame) {
  Swept out{{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}}, 0};
  for (const Target& target : targets) follow(target.from, target.to, out);
  out.largest /= frame.substeps;
  return out;
}

/// The swept box and largest displacement of mesh collider `c`, moved by keyframes or by the user; zero if it is
/// static.
Swept swept(const Model& model, const Control& control, int c, const PlannedFrame& frame) {
  const Carrier& carrier = model.objects[c].carrier;
  if (const ObjectControl* given = control.object(c); given != nullptr && !given->targets.empty())
    return swept(given->targets, frame);
  if (const PoseDrive* drive = control.mesh(c)) return drive->moves() ? swept(carrier, *drive, frame) : Swept{};
  return carrier.moves() ? swept(carrier, frame) : Swept{};
}

/// The box of an object's particles along ballistic paths, under gravity only, during the frame.
CarrierBox foreseen(const Model& model, const State& state, int object, double dt) {
  CarrierBox box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  const Vec3d fall = convert<double>(model.gravity) * (dt * dt);
  for (int i = model.first[object]; i < model.end_of(object); ++i) {
    const Record &x = state.positions[static_cast<std::size_t>(i)], &v = state.velocities[static_cast<std::size_t>(i)];
    const Vec3d from{x.x, x.y, x.z}, to = from + Vec3d{v.x, v.y, v.z} * dt + (x.w > 0 ? fall : Vec3d{});
    box = joined(box, {min(from, to), max(from, to)});
  }
  return box;
}

std::string too_fast(const CompiledObject& collider, const CompiledObject& object, double move, double thickness,
                     int substeps) {
  char text[160];
  std::snprintf(text, sizeof text,
                "moves %.3g m per substep, with %d substeps in this frame, and keeps %.3g m from object '", move,
                substeps, thickness);
  return "collider '" + collider.name + "': " + text + object.name +
         "': it may pass through; increase the thickness or the setting most_substeps";
}

/// The collider and the object that require the most substeps.
struct ColliderDemand {
  double substeps = 0;  ///< substeps required, before the limit is applied
  int collider = 0, object = 0;
};

std::string divides(const Model& model, const ColliderDemand& demand, int planned, int substeps) {
  char text[160];
  std::snprintf(text, sizeof text, "the frame has %d substeps instead of %d and takes about %.1f times as long",
                substeps, planned, static_cast<double>(substeps) / planned);
  return "collider '" + model.objects[demand.collider].name + "' moves fast near object '" +
         model.objects[demand.object].name + "': " + text +
         "; a slower collider or a greater thickness needs fewer substeps";
}

}  // namespace

int divided_substeps(const Model& model, const Control& control, const PairModel& pairs, const State& state,
                     const PlannedFrame& frame, std::vector<std::string>& warnings) {
  const int most = std::max(frame.substeps, frame.most_substeps);
  int substeps = frame.substeps;
  ColliderDemand demand;
  for (const int c : pairs.members) {
    const CompiledObject& collider = model.objects[c];
    if (!collider.is_collider) continue;
    const Swept sweep = swept(model, control, c, frame);
    if (!(sweep.largest > 0)) continue;
    for (const int o : pairs.members) {
      if (model.objects[o].is_collider || !pairs.shared->rules.meet(c, o)) continue;
      const double thickness = pairs.shared->rules.material(c, o).thickness,
                   allowed = displacement_over_thickness * thickness;
      if (!(allowed > 0) || !(sweep.largest > allowed)) continue;
      const double margin = thickness + sweep.largest * frame.substeps * 0.1;
      if (!come_near(sweep.box, foreseen(model, state, o, frame.dt), margin)) continue;
      const double wanted = std::ceil(frame.substeps * (sweep.largest / allowed));
      const int rounded =
          wanted < most ? (static_cast<int>(wanted) + frame.multiple - 1) / frame.multiple * frame.multiple : most;
      substeps = std::max(substeps, std::min(rounded, most));
      if (wanted > demand.substeps) demand = {wanted, c, o};
      if (wanted > most)
        warnings.push_back(
            too_fast(collider, model.objects[o], sweep.largest * frame.substeps / most, thickness, most));
    }
  }
  const int usual = std::max(frame.substeps, frame.usual_substeps);
  if (substeps > usual) warnings.push_back(divides(model, demand, usual, substeps));
  return substeps;
}

}  // namespace pliant
