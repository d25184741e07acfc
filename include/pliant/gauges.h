// Gauges measure liquids as an experiment does: the height at a place, the flow through an opening, the front of a
// wave, a force.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "pliant/scene.h"
#include "pliant/vec3.h"
#include "pliant/world.h"

namespace pliant {

/// The height of liquid over a footprint, by volume: the volume inside a box, over the area of its base [m].
struct HeightGauge {
  Vec3f low{}, high{};  ///< opposite corners of the box; low < high in each coordinate [m]
  int axis = 1;         ///< up: 0 for x, 1 for y, 2 for z
};

/// The volume of liquid that passes through a parallelogram, per second, averaged over the last frame [m^3/s].
struct FlowGauge {
  Vec3f corner{};            ///< [m]
  Vec3f side_a{}, side_b{};  ///< from the corner, neither zero nor parallel [m]; flow along side_a x side_b is positive
};

/// The place along a direction that a share of the liquid's volume is behind, measured from the origin [m].
struct FrontGauge {
  Vec3f direction{1, 0, 0};  ///< of any length but zero
  float share = 0.99f;       ///< of the volume, 0 < share < 1 [-]
};

/// The force with which liquids press on an object or a collider, averaged over the last frame [N]: by their pressure
/// and by the contact of their particles, without friction. An object is measured as a whole, with all its bodies.
struct ForceGauge {
  std::string on;             ///< name of an object that is no liquid, or of a collider or mesh collider
  Vec3f direction{0, -1, 0};  ///< of any length but zero; a force along it is positive
};

/// A gauge in a scene.
struct Gauge {
  std::string name;
  std::variant<HeightGauge, FlowGauge, FrontGauge, ForceGauge> measures{};
  std::vector<std::string> liquids{};  ///< names of the liquids that it measures; empty: all
};

/// The unit of a gauge: "m", "m^3/s" or "N".
std::string unit_of(const Gauge& gauge);

/// Reads the gauges of a World. A particle counts as a cube that is parallel to the axes, and whose side is the spacing
/// of its liquid; for a front or a flow as an interval of that length.
class Gauges {
 public:
  /// Gauges of a World that was just made from the scene. Turns the recording of contact events on if there is a force
  /// to measure. Throws an Error that names the gauge if a value is out of range, a name is empty or taken, or the
  /// scene has no liquid, object or collider of a name that it uses.
  Gauges(std::vector<Gauge> gauges, const Scene& scene, World& world);

  const std::vector<Gauge>& gauges() const { return gauges_; }

  /// Returns the value of each gauge. Call it once for the initial state and once after each step. A value is NaN where
  /// there is none: flow and force in the first call. Liquids that were removed from the World count no longer.
  std::vector<double> read(const World& world);

 private:
  /// A liquid, and where its particles were in the last call.
  struct Liquid {
    ObjectId object;
    double spacing = 0;  ///< [m]
    std::vector<Vec3f> positions, before;
    std::vector<double> ages;  ///< ObjectView::ages(); empty if its particles do not come and go
  };

  /// Calls body(place, spacing) for the particles of a liquid that are there.
  template <class Body>
  static void for_present(const Liquid& liquid, const Body& body);

  double value(const World& world, std::size_t gauge) const;
  double flow(const FlowGauge& through, const std::vector<int>& of) const;
  double force(const World& world, const ForceGauge& force, const std::vector<int>& of, const Thing& on) const;

  std::vector<Gauge> gauges_;
  std::vector<std::vector<int>> measured_;  ///< for each gauge, indices of the liquids that it measures
  std::vector<Thing> pressed_;              ///< for each gauge of a force, what is pressed
  std::vector<Liquid> liquids_;
  double duration_ = 0;  ///< time since the last call; 0 in the first call [s]
  double time_ = 0;      ///< of the last call [s]
  bool is_first_ = true;
};

}  // namespace pliant
