#include "solver/bodies/deep_overlaps.h"

#include <string>

#include "solver/bodies/contact_bodies.h"
#include "solver/bodies/depenetration.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// The deepest contact is named in the Report if it is deeper than this share of half of a body's thickness in so many
/// frames one after another: impacts are over sooner.
constexpr float deep_share = 0.2f;
constexpr int frames_of_rest = 6;

}  // namespace

void StartOverlaps::warn(Substep& s, const ContactBodies& bodies) const {
  if (count_ == 0) return;
  s.report.warnings.push_back(
      (count_ == 1 ? "1 pair of bodies overlaps" : std::to_string(count_) + " pairs of bodies overlap") +
      " where contact begins, deepest " + bodies.name(s.model, deepest_.a) + " and " +
      bodies.name(s.model, deepest_.b) + " by " + std::to_string(deepest_.depth) + " m: each pair is moved apart at " +
      std::to_string(depenetration_speed(deepest_.depth / deepest_.share)) +
      " m/s at most; place bodies apart, or if they meet fast give shorter frames or more substeps");
}

void DeepOverlaps::note(Substep& s, const ContactBodies& bodies, const BodyOverlap& deepest) {
  const bool goes_on = deepest.a == deepest_.a && deepest.b == deepest_.b;
  deepest_ = deepest;
  frames_ = deepest.share < deep_share ? 0 : goes_on ? frames_ + 1 : 1;
  if (frames_ < frames_of_rest) return;
  const auto name = [&](int place) { return bodies.name(s.model, place); };
  s.report.warnings.push_back(
      name(deepest.a) + " and " + name(deepest.b) + " overlap by " + std::to_string(deepest.depth) +
      " m: the weight, motor or joint that presses them together is too strong for " + std::to_string(s.planned) +
      " substeps; contacts give way by 1.04 h^2 F / m, so twice the substeps bear four times the weight");
}

}  // namespace pliant
