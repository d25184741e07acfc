// Parts of a Report as JSON, and the whole of one.
#include "io/report_parts.h"

#include <array>

#include "pliant/io.h"

namespace pliant::report_parts {

namespace {

/// The name of an object; null if it is no more.
Json name_in(const World& world, ObjectId id) { return world.has(id) ? Json(world.object(id).name()) : Json(); }

Json estimate_json(const World& world, const ConvergenceEstimate& of) {
  return {
      {"excess", of.excess}, {"strain", of.strain}, {"object", name_in(world, of.object)}, {"substeps", of.substeps}};
}

Json stretch_json(const Stretch& of) { return {{"mean", of.mean}, {"p99", of.p99}, {"largest", of.largest}}; }

Json overstretch_json(const World& world, const Overstretch& of) {
  return {{"p99", of.p99},
          {"largest", of.largest},
          {"object", name_in(world, ObjectId(of.object, of.generation))},
          {"particles", of.particles},
          {"constraints", of.constraints}};
}

Json worst_overstretch_json(const World& world, const WorstOverstretch& of) {
  Json json = overstretch_json(world, of.overstretch);
  json["frame_of_p99"] = of.frame_of_p99;
  json["frame_of_largest"] = of.frame_of_largest;
  return json;
}

Json residuals_json(const std::vector<Residual>& residuals) {
  Json json = Json::object();
  for (const Residual& one : residuals)
    json[one.type] = {{"constraints", one.constraints}, {"rms", one.rms}, {"largest", one.largest}};
  return json;
}

Json iterations_json(const std::vector<IterationResidual>& of) {
  Json json = Json::array();
  for (const IterationResidual& one : of)
    json.push_back({{"iteration", one.iteration},
                    {"primal", residuals_json(one.primal)},
                    {"dual_rms", one.dual_rms},
                    {"dual_largest", one.dual_largest}});
  return json;
}

Json torn_json(const World& world, const std::vector<Torn>& of) {
  Json json = Json::array();
  for (const Torn& torn : of)
    json.push_back({{"object", name_in(world, torn.object)},
                    {"new_particles", torn.new_particles},
                    {"lost_constraints", torn.lost_constraints}});
  return json;
}

Json breaks_json(const World& world, const std::vector<JointBreak>& of) {
  Json json = Json::array();
  for (const JointBreak& broken : of)
    json.push_back({{"object", name_in(world, broken.object)}, {"joint", broken.joint}, {"name", broken.name}});
  return json;
}

Json phases_json(const std::vector<PhaseTime>& phases) {
  Json json = Json::object();
  for (const PhaseTime& phase : phases) json[phase.name] = phase.milliseconds;
  return json;
}

/// What the solves of a frame left.
void add_accuracy(const Report& report, const World& world, Json& json) {
  json["overstretch"] = report.overstretch ? overstretch_json(world, *report.overstretch) : Json();
  json["worst_overstretch"] = worst_overstretch_json(world, report.worst_overstretch);
  json["estimates"] = estimates_json(world, report);
  json["widest_tie"] = tie_json(world, report.widest_tie);
  json["residuals"] = residuals_json(report.residuals);
  json["stretch"] = report.stretch ? stretch_json(*report.stretch) : Json();
  json["convergence"] = iterations_json(report.convergence);
  json["compression"] = {{"mean", report.compression.mean},
                         {"largest", report.compression.largest},
                         {"crowded", report.compression.crowded}};
  json["viscosity"] = {{"iterations", report.viscosity.iterations},
                       {"unfinished", report.viscosity.unfinished},
                       {"residual", report.viscosity.residual}};
  json["surface_tension_share"] = report.tension.share;
  json["lost_momentum"] = lost_momentum_json(report.lost_momentum);
}

}  // namespace

Json pairs_json(const PairReport& pairs) {
  return {{"candidates", pairs.candidates},
          {"contacts", pairs.contacts},
          {"initially_intersecting", pairs.initially_intersecting},
          {"truncated", pairs.truncated},
          {"unresolvable", pairs.unresolvable},
          {"rebuilds", pairs.rebuilds},
          {"inside", pairs.inside},
          {"deepest", pairs.deepest}};
}

Json estimates_json(const World& world, const Report& report) {
  Json json = Json::object();
  for (std::size_t k = 0; k < resistance_count; ++k) {
    const WorstEstimates& worst = report.worst_estimates;
    if (worst.frames[k] == 0) continue;
    json[name_of(static_cast<Resistance>(k))] = {{"last", estimate_json(world, report.estimates[k])},
                                                 {"worst", estimate_json(world, worst.estimates[k])},
                                                 {"frame_of_worst", worst.frames[k]}};
  }
  return json;
}

Json nonfinite_json(const Report& report) {
  if (!report.nonfinite) return nullptr;
  const NonFinite& found = *report.nonfinite;
  return {{"object", found.object},
          {"element", found.element},
          {"frame", found.frame},
          {"substep", found.substep},
          {"message", report.explain()}};
}

Json flow_json(const FlowReport& flow) {
  return {{"emitted", flow.emitted}, {"drained", flow.drained}, {"expired", flow.expired},
          {"refused", flow.refused}, {"blocked", flow.blocked}, {"soaked", flow.soaked},
          {"seeped", flow.seeped},   {"dripped", flow.dripped}, {"present", flow.present}};
}

Json lost_momentum_json(const LostMomentum& lost) {
  return {{"filter", lost.filter}, {"guards", lost.guards}, {"sleep", lost.sleep}};
}

Json tie_json(const World& world, const TieGap& tie) {
  if (tie.body < 0) return nullptr;
  return {{"object", name_in(world, tie.object)},
          {"particle", tie.particle},
          {"body", tie.body},
          {"gap", tie.gap},
          {"length", tie.length}};
}

}  // namespace pliant::report_parts

namespace pliant {

std::string report_json(const Report& report, const World& world) {
  using namespace report_parts;
  Json json;
  json["frame"] = report.frame;
  json["time"] = report.time;
  json["ok"] = report.ok();
  json["stopped"] = report.stopped;
  json["milliseconds"] = report.milliseconds;
  json["phases"] = phases_json(report.phases);
  json["substeps"] = report.substeps;
  json["iterations"] = {{"smallest", report.iterations.smallest},
                        {"largest", report.iterations.largest},
                        {"mean", report.iterations.mean}};
  json["contacts"] = report.contacts;
  json["pairs"] = pairs_json(report.pairs);
  add_accuracy(report, world, json);
  json["flow"] = flow_json(report.flow);
  json["sleeping_bodies"] = report.sleeping_bodies;
  json["sleeping_grains"] = report.sleeping_grains;
  json["torn"] = torn_json(world, report.torn);
  json["broken_joints"] = breaks_json(world, report.broken_joints);
  json["nonfinite"] = nonfinite_json(report);
  json["warnings"] = report.warnings;
  // Invalid UTF-8 is replaced, because a name may contain it.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace pliant
