// All rows as JSON, in one unit, because the JSON library takes seconds to compile.
#include <nlohmann/json.hpp>

#include "apps/bench/bench.h"
#include "apps/bench/chains.h"
#include "apps/bench/columns.h"
#include "apps/bench/contact.h"
#include "apps/bench/covered.h"
#include "apps/bench/landing.h"
#include "apps/bench/liquid.h"
#include "apps/bench/memory.h"
#include "apps/bench/piles.h"
#include "apps/bench/scene_table.h"
#include "apps/bench/soft_bodies.h"
#include "apps/bench/tears.h"

namespace pliant::bench {

std::string to_json(const std::vector<Row>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    list.push_back({{"workload", row.workload},
                    {"size", row.size},
                    {"engine", row.engine},
                    {"threads", row.threads},
                    {"substeps", row.substeps},
                    {"iterations", row.iterations},
                    {"ms_per_frame", row.ms_per_frame},
                    {"ns_per_projection", row.ns_per_projection},
                    {"stretch_mean", row.stretch_mean},
                    {"stretch_p99", row.stretch_p99},
                    {"stretch_max", row.stretch_max},
                    {"energy_lost", row.energy_lost},
                    {"met", row.met},
                    {"ratio", row.ratio}});
    for (const PhaseTime& phase : row.phases) list.back()["phases_ms"][phase.name] = phase.milliseconds;
  }
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<ChainRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ChainRow& row : rows)
    list.push_back({{"links", row.links},
                    {"solver", row.solver},
                    {"substeps", row.substeps},
                    {"ms_per_frame", row.ms_per_frame},
                    {"drift", row.drift},
                    {"ratio", row.ratio}});
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<ColumnRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ColumnRow& row : rows)
    list.push_back({{"depth", row.depth},
                    {"spacing", row.spacing},
                    {"particles", row.particles},
                    {"substeps", row.substeps},
                    {"iterations", row.iterations},
                    {"default", row.is_default},
                    {"mean", row.mean},
                    {"largest", row.largest},
                    {"speed", row.speed},
                    {"fastest", row.fastest},
                    {"height", row.height},
                    {"ns", row.ns},
                    {"ms_per_1000", row.ms_per_1000}});
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<ContactRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ContactRow& row : rows)
    list.push_back({{"size", row.size},
                    {"particles", row.particles},
                    {"without_ms", row.without_ms},
                    {"with_ms", row.with_ms},
                    {"ratio", row.ratio},
                    {"largest_ms", row.largest_ms},
                    {"with_us_per_particle", row.with_us_per_particle},
                    {"candidates_per_particle", row.candidates_per_particle},
                    {"lists", row.lists}});
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<CoveredRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const CoveredRow& row : rows)
    list.push_back({{"workload", "covered"},
                    {"what", row.what},
                    {"size", row.size},
                    {"bodies", row.bodies},
                    {"frames", row.frames},
                    {"mean_ms", row.mean_ms},
                    {"median_ms", row.median_ms},
                    {"largest_ms", row.largest_ms},
                    {"worst_crossings", row.worst_crossings},
                    {"frames_with_crossings", row.frames_with_crossings},
                    {"unnamed", row.unnamed},
                    {"ratio", row.ratio}});
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<LandingRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LandingRow& row : rows)
    list.push_back({{"workload", "W3-" + row.on},
                    {"size", row.size},
                    {"engine", row.engine},
                    {"substeps", row.substeps},
                    {"iterations", row.iterations},
                    {"frames", row.frames},
                    {"in_time", row.in_time},
                    {"mean_ms", row.mean_ms},
                    {"median_ms", row.median_ms},
                    {"largest_ms", row.largest_ms},
                    {"crossings", row.crossings},
                    {"stretch_mean", row.stretch_mean},
                    {"stretch_p99", row.stretch_p99},
                    {"ratio", row.ratio}});
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<LiquidRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LiquidRow& row : rows)
    list.push_back({{"particles", row.particles},
                    {"engine", row.engine},
                    {"isa", row.isa},
                    {"substeps", row.substeps},
                    {"median_ms", row.median_ms},
                    {"largest_ms", row.largest_ms},
                    {"ns_per_particle", row.ns_per_particle},
                    {"search", row.search},
                    {"compression", row.compression},
                    {"ratio", row.ratio},
                    {"bytes", row.bytes},
                    {"surface", row.surface}});
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<MemoryRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const MemoryRow& row : rows)
    list.push_back({{"size", row.size},
                    {"sweep", sweep_name(row.sweep)},
                    {"scene", row.scene},
                    {"scene_peak", row.scene_peak},
                    {"peak", row.peak},
                    {"peak_given_away", row.peak_given_away},
                    {"world", row.world}});
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<PileRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PileRow& row : rows) {
    nlohmann::ordered_json snapshots = nlohmann::ordered_json::array();
    for (const PileSnapshot& snapshot : row.snapshots)
      snapshots.push_back(
          {{"frame", snapshot.frame}, {"moved", snapshot.moved}, {"speed", snapshot.speed}, {"lost", snapshot.lost}});
    list.push_back({{"workload", "bodies-" + row.pile},
                    {"size", row.size},
                    {"bodies", row.bodies},
                    {"engine", row.engine},
                    {"threads", row.threads},
                    {"substeps", row.substeps},
                    {"frames", row.frames},
                    {"mean_ms", row.mean_ms},
                    {"largest_ms", row.largest_ms},
                    {"snapshots", snapshots},
                    {"ratio", row.ratio}});
  }
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<SceneRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SceneRow& row : rows)
    list.push_back({{"scene", row.scene},
                    {"settings", row.settings},
                    {"particles", row.particles},
                    {"frames", row.frames},
                    {"p99", row.p99},
                    {"frame_of_p99", row.frame_of_p99},
                    {"largest", row.largest},
                    {"frame_of_largest", row.frame_of_largest},
                    {"energy_gain", row.gain},
                    {"energy_gain_with_bending", row.gain_with_bending},
                    {"moved", row.moved},
                    {"ms_per_frame", row.milliseconds},
                    {"substeps", row.substeps},
                    {"crossings", row.crossings},
                    {"yield", row.yield},
                    {"finite", row.finite},
                    {"cheapest", row.cheapest},
                    {"ratio", row.ratio}});
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<SoftBodyRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SoftBodyRow& row : rows)
    list.push_back({{"cells", row.cells},
                    {"tetrahedra", row.tetrahedra},
                    {"projections", row.projections},
                    {"material", row.material},
                    {"engine", row.engine},
                    {"substeps", row.substeps},
                    {"median_ms", row.median_ms},
                    {"ns", row.ns},
                    {"ratio", row.ratio},
                    {"inverted", row.inverted},
                    {"worst", row.worst},
                    {"set_up_ms", row.set_up_ms}});
  return list.dump(2) + "\n";
}

std::string to_json(const std::vector<TearRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const TearRow& row : rows)
    list.push_back({{"object", row.object},
                    {"cells", row.cells},
                    {"elements", row.elements},
                    {"substeps", row.substeps},
                    {"cuts", row.cuts},
                    {"copies", row.copies},
                    {"whole_ms", row.whole_ms},
                    {"cut_ms", row.cut_ms},
                    {"ratio", row.ratio},
                    {"us_per_copy", row.us_per_copy},
                    {"ns_per_element", row.ns_per_element}});
  return list.dump(2) + "\n";
}

}  // namespace pliant::bench
