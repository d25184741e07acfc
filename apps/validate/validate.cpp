// The list of groups, and the table and JSON of rows.
#include "apps/validate/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/validate/rows.h"
#include "pliant/error.h"

namespace pliant::validate {
namespace {

using AddRows = void (*)(Result&, bool);

const AddRows adders[] = {
    spring_rows,      chain_rows,       momentum_rows,  pendulum_rows, contact_rows, body_rows,  mechanism_rows,
    motion_rows,      collision_rows,   stiffness_rows, bending_rows,  balloon_rows, drape_rows, steadiness_rows,
    convergence_rows, heavy_chain_rows, sweep_rows,     liquid_rows,   solid_rows,   grain_rows, woven_rows};

const char* word(Comparison comparison) {
  switch (comparison) {
    case Comparison::relative:
      return "relative";
    case Comparison::absolute:
      return "absolute";
    case Comparison::at_least:
      return "at least";
    default:
      return "at most";
  }
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value);
  return text;
}

// JSON has neither infinity nor NaN.
nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

}  // namespace

const std::vector<Group>& groups() {
  static const std::vector<Group> all{
      {"spring", "a mass on a spring: backward Euler step by step, static stretch, free fall"},
      {"chain", "a hanging chain, a chain with a heavy end, a chain between two nails"},
      {"momentum", "momentum, which internal constraints conserve; gradients"},
      {"pendulum", "period against amplitude, energy"},
      {"contact", "incline, stopping distance, bounce"},
      {"bodies", "rigid bodies: tumbling, friction, impacts, stacks"},
      {"mechanisms", "bodies in joints: compound pendulum, top, four-bar linkage"},
      {"motion", "amplitude of first modes after ten periods, times of damping"},
      {"collision", "pairs, continuous tests, surfaces on surfaces, with the filter and without"},
      {"stiffness", "a rest shape that is independent of iterations, time step and mesh"},
      {"bending", "cantilevers of the fabrics against the beam's formula"},
      {"balloon", "volume against pressure"},
      {"drape", "the drape coefficient of the fabrics by Cusick's test"},
      {"steadiness", "the inextensible cloth hung by two corners stays bounded"},
      {"convergence", "number of sweeps of each method on a free chain"},
      {"heavy_chain", "a load 100 000 times as heavy as a link, by exact chains"},
      {"sweeps", "the same known answers with every sweep, and the exceptions"},
      {"liquids", "a dam break against an experiment, a column at rest, pressure, sloshing, a jet, momentum"},
      {"solids", "bars in tension and bent, blocks that stand, with the default settings"},
      {"grains", "a silo by Janssen, an hourglass by Beverloo"},
      {"woven", "stretch and shear of woven cloth by its weight"},
  };
  return all;
}

Result run_validation(const Options& options) {
  Result result;
  std::string names;
  bool found = false;
  for (std::size_t i = 0; i < groups().size(); ++i) {
    names += (i == 0 ? "" : ", ") + groups()[i].name;
    if (options.name && *options.name != groups()[i].name) continue;
    found = true;
    if (groups()[i].name == "collision" && !options.queries.empty()) query_set_rows(result, options.queries);
    adders[i](result, options.slow);
  }
  if (!found) throw Error({}, "there is no group '" + *options.name + "' to validate", "choose one of " + names);
  return result;
}

std::string to_table(const std::vector<Row>& rows) {
  const std::vector<std::string> heads{"what", "expected", "measured", "tolerance", "unit", "verdict", "how"};
  std::vector<std::vector<std::string>> lines{heads};
  for (const Row& row : rows) {
    const bool is_bound = row.comparison == Comparison::at_most || row.comparison == Comparison::at_least;
    const char* before = !is_bound ? "" : row.comparison == Comparison::at_most ? "<= " : ">= ";
    std::string tolerance = number(row.tolerance) + (row.comparison == Comparison::relative ? " x" : "");
    if (is_bound) tolerance = "-";
    lines.push_back({row.name, before + number(row.expected), number(row.measured), tolerance,
                     row.unit.empty() ? "-" : row.unit, row.pass ? "pass" : "FAIL", row.note});
  }
  std::vector<std::size_t> widths(heads.size());
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const auto& line : lines) {
    std::string printed;
    for (std::size_t i = 0; i < line.size(); ++i) printed += padded(line[i], widths[i] + 2);
    text += printed.substr(0, printed.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string to_json(const std::vector<Row>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Row& row : rows)
    list.push_back({{"name", row.name},
                    {"expected", json_number(row.expected)},
                    {"measured", json_number(row.measured)},
                    {"tolerance", row.tolerance},
                    {"comparison", word(row.comparison)},
                    {"unit", row.unit},
                    {"pass", row.pass},
                    {"note", row.note}});
  return list.dump(2) + "\n";
}

}  // namespace pliant::validate
