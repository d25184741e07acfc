// The report of a World's last step.
#include "memory.h"
#include "pliant/io.h"
#include "world_handle.h"

namespace pliant::c {

namespace {

/// A number of the Report by the path of its members, as `report.pairs.contacts`.
#define PLIANT_C_NUMBER(path)                                                    \
  {                                                                              \
#path, [](const Report& report) { return static_cast<double>(report.path); } \
  }

/// The names are those of report_json(), joined by points.
const NamedNumber<const Report&> numbers[] = {
    PLIANT_C_NUMBER(frame),
    PLIANT_C_NUMBER(time),
    PLIANT_C_NUMBER(milliseconds),
    PLIANT_C_NUMBER(substeps),
    PLIANT_C_NUMBER(iterations.smallest),
    PLIANT_C_NUMBER(iterations.largest),
    PLIANT_C_NUMBER(iterations.mean),
    PLIANT_C_NUMBER(contacts),
    PLIANT_C_NUMBER(pairs.candidates),
    PLIANT_C_NUMBER(pairs.contacts),
    PLIANT_C_NUMBER(pairs.initially_intersecting),
    PLIANT_C_NUMBER(pairs.truncated),
    PLIANT_C_NUMBER(pairs.unresolvable),
    PLIANT_C_NUMBER(pairs.rebuilds),
    PLIANT_C_NUMBER(pairs.inside),
    PLIANT_C_NUMBER(pairs.deepest),
    {"overstretch.p99", [](const Report& report) { return report.overstretch ? report.overstretch->p99 : 0; }},
    {"overstretch.largest", [](const Report& report) { return report.overstretch ? report.overstretch->largest : 0; }},
    {"worst_overstretch.p99", [](const Report& report) { return report.worst_overstretch.overstretch.p99; }},
    {"worst_overstretch.largest", [](const Report& report) { return report.worst_overstretch.overstretch.largest; }},
    PLIANT_C_NUMBER(worst_overstretch.frame_of_p99),
    PLIANT_C_NUMBER(worst_overstretch.frame_of_largest),
    PLIANT_C_NUMBER(widest_tie.gap),
    PLIANT_C_NUMBER(widest_tie.length),
    PLIANT_C_NUMBER(compression.mean),
    PLIANT_C_NUMBER(compression.largest),
    PLIANT_C_NUMBER(compression.crowded),
    PLIANT_C_NUMBER(viscosity.iterations),
    PLIANT_C_NUMBER(viscosity.unfinished),
    PLIANT_C_NUMBER(viscosity.residual),
    {"surface_tension_share", [](const Report& report) { return static_cast<double>(report.tension.share); }},
    PLIANT_C_NUMBER(flow.emitted),
    PLIANT_C_NUMBER(flow.drained),
    PLIANT_C_NUMBER(flow.expired),
    PLIANT_C_NUMBER(flow.refused),
    PLIANT_C_NUMBER(flow.blocked),
    PLIANT_C_NUMBER(flow.soaked),
    PLIANT_C_NUMBER(flow.seeped),
    PLIANT_C_NUMBER(flow.dripped),
    PLIANT_C_NUMBER(flow.present),
    PLIANT_C_NUMBER(lost_momentum.filter),
    PLIANT_C_NUMBER(lost_momentum.guards),
    PLIANT_C_NUMBER(lost_momentum.sleep),
    PLIANT_C_NUMBER(sleeping_bodies),
    PLIANT_C_NUMBER(sleeping_grains),
};
#undef PLIANT_C_NUMBER

}  // namespace

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_report_ok(const pliant_world* world, int32_t* ok) {
  return guarded([&] {
    const auto of = at(world);
    require(ok, "ok");
    *ok = of->report.ok() ? 1 : 0;
  });
}

pliant_status pliant_report_number(const pliant_world* world, const char* name, double* value) {
  return guarded([&] {
    const auto of = at(world);
    require(name, "name");
    require(value, "value");
    const auto* number = find_number(numbers, name);
    if (number == nullptr)
      throw StatusError(PLIANT_NOT_FOUND, std::string("a report has no number '") + name + "'",
                        "pliant_report_number_name lists them");
    *value = number->value(of->report);
  });
}

const char* pliant_report_number_name(size_t index) {
  return index < std::size(numbers) ? numbers[index].name : nullptr;
}

pliant_status pliant_report_explain(const pliant_world* world, char* into, size_t capacity, size_t* length) {
  return guarded([&] { give_text(at(world)->report.explain(), {into, capacity, length}); });
}

pliant_status pliant_report_advice(const pliant_world* world, char* into, size_t capacity, size_t* length) {
  return guarded([&] {
    const auto of = at(world);
    give_text(of->world.measure().advice(of->report), {into, capacity, length});
  });
}

pliant_status pliant_report_json(const pliant_world* world, char* into, size_t capacity, size_t* length) {
  return guarded([&] {
    const auto of = at(world);
    give_text(report_json(of->report, of->world), {into, capacity, length});
  });
}
