// Parts of a Report as JSON, for report_json and for the report of a run.
#pragma once

#include <nlohmann/json.hpp>

#include "pliant/report.h"
#include "pliant/world.h"

namespace pliant::report_parts {

using Json = nlohmann::ordered_json;

Json pairs_json(const PairReport& pairs);
Json flow_json(const FlowReport& flow);
Json lost_momentum_json(const LostMomentum& lost);
/// The convergence estimates of the last frame, and the worst of any, by kind; without kinds that the scene lacks.
Json estimates_json(const World& world, const Report& report);
/// A rigid tie; null without one.
Json tie_json(const World& world, const TieGap& tie);
/// Where the first value that is not finite arose, and what explain() says; null if there is none.
Json nonfinite_json(const Report& report);

}  // namespace pliant::report_parts
