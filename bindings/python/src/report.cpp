// pliant.Report: what a step did, as attributes and as a dict.

#include "bindings.h"
#include "pliant/describe.h"

namespace pliant::python {

namespace {

nb::dict dict_of(const PairReport& pairs) {
  nb::dict dict;
  dict["candidates"] = pairs.candidates;
  dict["contacts"] = pairs.contacts;
  dict["truncated"] = pairs.truncated;
  dict["unresolvable"] = pairs.unresolvable;
  dict["initially_intersecting"] = pairs.initially_intersecting;
  dict["rebuilds"] = pairs.rebuilds;
  dict["inside"] = pairs.inside;
  dict["deepest"] = pairs.deepest;
  return dict;
}

nb::dict dict_of(const Overstretch& found, const Names& names) {
  nb::dict dict;
  dict["p99"] = found.p99;
  dict["largest"] = found.largest;
  dict["constraints"] = found.constraints;
  const bool is_known = found.object >= 0;
  dict["object"] =
      is_known ? nb::object(nb::str(names.of(ObjectId{found.object, found.generation}).c_str())) : nb::none();
  dict["particles"] = is_known ? nb::object(nb::make_tuple(found.particles[0], found.particles[1])) : nb::none();
  return dict;
}

nb::object object_of(const std::optional<Overstretch>& found, const Names& names) {
  return found ? nb::object(dict_of(*found, names)) : nb::none();
}

nb::object object_of(const std::optional<Stretch>& stretch) {
  if (!stretch) return nb::none();
  nb::dict dict;
  dict["mean"] = stretch->mean;
  dict["p99"] = stretch->p99;
  dict["largest"] = stretch->largest;
  return nb::object(dict);
}

nb::object object_of(const std::optional<NonFinite>& found) {
  if (!found) return nb::none();
  nb::dict dict;
  dict["object"] = found->object;
  dict["element"] = found->element;
  dict["frame"] = found->frame;
  dict["substep"] = found->substep;
  return nb::object(dict);
}

nb::dict dict_of(const FlowReport& flow) {
  nb::dict dict;
  dict["emitted"] = flow.emitted;
  dict["drained"] = flow.drained;
  dict["expired"] = flow.expired;
  dict["refused"] = flow.refused;
  dict["blocked"] = flow.blocked;
  dict["soaked"] = flow.soaked;
  dict["seeped"] = flow.seeped;
  dict["dripped"] = flow.dripped;
  dict["present"] = flow.present;
  return dict;
}

nb::dict phases_of(const Report& report) {
  nb::dict dict;
  for (const PhaseTime& phase : report.phases) dict[nb::str(std::string(phase.name).c_str())] = phase.milliseconds;
  return dict;
}

nb::dict iterations_of(const Report& report) {
  nb::dict dict;
  dict["smallest"] = report.iterations.smallest;
  dict["largest"] = report.iterations.largest;
  dict["mean"] = report.iterations.mean;
  return dict;
}

nb::dict lost_momentum_of(const Report& report) {
  nb::dict dict;
  dict["filter"] = report.lost_momentum.filter;
  dict["guards"] = report.lost_momentum.guards;
  dict["sleep"] = report.lost_momentum.sleep;
  return dict;
}

nb::dict compression_of(const Report& report) {
  nb::dict dict;
  dict["mean"] = report.compression.mean;
  dict["largest"] = report.compression.largest;
  dict["crowded"] = report.compression.crowded;
  return dict;
}

nb::list torn_of(const NamedReport& named) {
  nb::list list;
  for (const Torn& torn : named.report.torn) {
    nb::dict dict;
    dict["object"] = named.names->of(torn.object);
    dict["new_particles"] = torn.new_particles;
    dict["lost_constraints"] = torn.lost_constraints;
    list.append(dict);
  }
  return list;
}

nb::list broken_joints_of(const NamedReport& named) {
  nb::list list;
  for (const JointBreak& broken : named.report.broken_joints) {
    nb::dict dict;
    dict["object"] = named.names->of(broken.object);
    dict["joint"] = broken.joint;
    dict["name"] = broken.name;
    list.append(dict);
  }
  return list;
}

nb::list residuals_of(const Report& report) {
  nb::list list;
  for (const Residual& residual : report.residuals) {
    nb::dict dict;
    dict["type"] = residual.type;
    dict["rms"] = residual.rms;
    dict["largest"] = residual.largest;
    list.append(dict);
  }
  return list;
}

nb::dict estimates_of(const NamedReport& named) {
  nb::dict dict;
  for (std::size_t kind = 0; kind < resistance_count; ++kind) {
    const ConvergenceEstimate& estimate = named.report.estimates[kind];
    if (estimate.constraints == 0) continue;
    nb::dict one;
    one["excess"] = estimate.excess;
    one["strain"] = estimate.strain;
    one["object"] = named.names->of(estimate.object);
    one["substeps"] = estimate.substeps;
    one["constraints"] = estimate.constraints;
    dict[name_of(static_cast<Resistance>(kind))] = one;
  }
  return dict;
}

constexpr const char* keys[] = {"frame",
                                "time",
                                "milliseconds",
                                "substeps",
                                "contacts",
                                "pairs",
                                "residuals",
                                "stretch",
                                "iterations",
                                "overstretch",
                                "worst_overstretch",
                                "compression",
                                "flow",
                                "lost_momentum",
                                "sleeping_bodies",
                                "sleeping_grains",
                                "torn",
                                "broken_joints",
                                "nonfinite",
                                "stopped",
                                "warnings",
                                "estimates",
                                "phases",
                                "ok"};

std::string repr(const NamedReport& named) {
  const Report& report = named.report;
  std::string text = "<pliant.Report: frame " + std::to_string(report.frame) + ", " + std::to_string(report.substeps) +
                     " substeps, " + std::to_string(report.contacts + report.pairs.contacts) + " contacts";
  if (!report.ok()) text += ", not finite";
  if (report.stopped) text += ", stopped";
  if (!report.warnings.empty()) text += ", " + std::to_string(report.warnings.size()) + " warnings";
  return text + ">";
}

}  // namespace

std::string Names::of(ObjectId id) const {
  const auto found = objects.find(id);
  return found == objects.end() ? std::string{} : found->second;
}

std::string Names::of(const Thing& thing) const {
  if (thing.kind == Thing::Kind::object) return of(ObjectId{thing.slot, thing.generation});
  if (thing.kind == Thing::Kind::collider) {
    const auto found = colliders.find(ColliderId{thing.slot, thing.generation});
    return found == colliders.end() ? std::string{} : found->second;
  }
  const auto found = mesh_colliders.find(MeshColliderId{thing.slot, thing.generation});
  return found == mesh_colliders.end() ? std::string{} : found->second;
}

namespace {

nb::dict as_dict(nb::handle self) {
  nb::dict dict;
  for (const char* key : keys) dict[key] = self.attr(key);
  return dict;
}

/// A member of Report as it is.
constexpr auto whole = [](auto Report::*member) {
  return [member](const NamedReport& named) { return named.report.*member; };
};

void bind_happenings(nb::class_<NamedReport>& c) {
  c.def_prop_ro("sleeping_bodies", whole(&Report::sleeping_bodies), "Rigid bodies that sleep.")
      .def_prop_ro("sleeping_grains", whole(&Report::sleeping_grains), "Grains that sleep.")
      .def_prop_ro("torn", &torn_of, nb::sig("def torn(self) -> list[dict[str, typing.Any]]"),
                   "Objects that tore or were cut: object, new_particles, lost_constraints.")
      .def_prop_ro("broken_joints", &broken_joints_of,
                   nb::sig("def broken_joints(self) -> list[dict[str, typing.Any]]"),
                   "Joints that broke in this step: object, joint (index), name.")
      .def_prop_ro(
          "nonfinite", [](const NamedReport& r) { return object_of(r.report.nonfinite); },
          nb::sig("def nonfinite(self) -> dict[str, typing.Any] | None"),
          "Where the first value that is not finite arose: object, element, frame, substep; else None.")
      .def_prop_ro("stopped", whole(&Report::stopped),
                   "True if Ctrl-C or World.stop() ended the step within the frame.")
      .def_prop_ro("warnings", whole(&Report::warnings), "Warnings, one sentence each.")
      .def_prop_ro(
          "estimates", &estimates_of, nb::sig("def estimates(self) -> dict[str, dict[str, typing.Any]]"),
          "How far from converged the solve of stretching, bending, ... is, as docs/internals/convergence.md explains.")
      .def_prop_ro(
          "phases", [](const NamedReport& r) { return phases_of(r.report); },
          nb::sig("def phases(self) -> dict[str, float]"), "Time of each phase [ms].")
      .def_prop_ro(
          "ok", [](const NamedReport& r) { return r.report.ok(); }, "False if a value was not finite.")
      .def(
          "explain", [](const NamedReport& r) { return r.report.explain(); }, "Problems and warnings as text.")
      .def(
          "describe", [](const NamedReport& r) { return describe(r.report); },
          "Frame, time, cost, contacts, the worst overstretch, and all that explain() says, for people to read.");
}

void bind_mapping(nb::class_<NamedReport>& c) {
  c.def("as_dict", &as_dict, nb::sig("def as_dict(self) -> dict[str, typing.Any]"),
        "All values as a dict that JSON can hold.")
      .def(
          "keys",
          [](const NamedReport& /*self*/) {
            nb::list list;
            for (const char* key : keys) list.append(key);
            return list;
          },
          nb::sig("def keys(self) -> list[str]"), "The names of all values.")
      .def(
          "__getitem__",
          [](nb::handle self, const std::string& key) -> nb::object {
            for (const char* one : keys)
              if (key == one) return self.attr(one);
            throw nb::key_error(("a Report has no '" + key + "'").c_str());
          },
          nb::arg("key"), nb::sig("def __getitem__(self, key: str, /) -> typing.Any"), "A value by name.")
      .def(
          "__iter__", [](nb::handle self) { return nb::iter(self.attr("keys")()); },
          nb::sig("def __iter__(self) -> collections.abc.Iterator[str]"), "Iterates over the names of all values.")
      .def(
          "__len__", [](const NamedReport& /*self*/) { return std::size(keys); }, "The number of values.")
      .def("__repr__", &repr);
}

}  // namespace

void bind_report(nb::module_& m) {
  nb::class_<NamedReport> c(
      m, "Report", nb::type_slots(plain_slots()),
      "What a step did. Values are attributes, and also items as of a dict: report[\"contacts\"]. Names of objects are "
      "those at the time of the step.");
  c.def_prop_ro("frame", whole(&Report::frame), "Number of complete frames.")
      .def_prop_ro("time", whole(&Report::time), "Simulated time [s].")
      .def_prop_ro("milliseconds", whole(&Report::milliseconds), "Time that the step took [ms].")
      .def_prop_ro("substeps", whole(&Report::substeps), "Substeps of this frame; the most of any object.")
      .def_prop_ro("contacts", whole(&Report::contacts),
                   "Contacts with colliders and rigid bodies in the last substep.")
      .def_prop_ro(
          "pairs", [](const NamedReport& r) { return dict_of(r.report.pairs); },
          nb::sig("def pairs(self) -> dict[str, typing.Any]"),
          "Contact between surfaces: candidates, contacts, truncated, unresolvable, initially_intersecting, rebuilds, "
          "inside, "
          "deepest [m].")
      .def_prop_ro(
          "residuals", [](const NamedReport& r) { return residuals_of(r.report); },
          nb::sig("def residuals(self) -> list[dict[str, typing.Any]]"),
          "Residuals by type of constraint: type, rms, largest. Filled if settings.measure is set.")
      .def_prop_ro(
          "stretch", [](const NamedReport& r) { return object_of(r.report.stretch); },
          nb::sig("def stretch(self) -> dict[str, float] | None"),
          "Length over rest length: mean, p99, largest [-]. None unless settings.measure is set.")
      .def_prop_ro(
          "iterations", [](const NamedReport& r) { return iterations_of(r.report); },
          nb::sig("def iterations(self) -> dict[str, float]"), "Iterations a substep: smallest, largest, mean.")
      .def_prop_ro(
          "overstretch", [](const NamedReport& r) { return object_of(r.report.overstretch, *r.names); },
          nb::sig("def overstretch(self) -> dict[str, typing.Any] | None"),
          "By how much lengths exceed what their force explains: p99, largest [-], object, particles, constraints. "
          "None if "
          "the "
          "frame was not completed.")
      .def_prop_ro(
          "worst_overstretch",
          [](const NamedReport& r) { return dict_of(r.report.worst_overstretch.overstretch, *r.names); },
          nb::sig("def worst_overstretch(self) -> dict[str, typing.Any]"),
          "The same for the worst frames since the World was made or a State restored.")
      .def_prop_ro(
          "compression", [](const NamedReport& r) { return compression_of(r.report); },
          nb::sig("def compression(self) -> dict[str, float]"),
          "How much denser than at rest liquids are: mean, largest [-], crowded (particles).")
      .def_prop_ro(
          "flow", [](const NamedReport& r) { return dict_of(r.report.flow); },
          nb::sig("def flow(self) -> dict[str, int]"), "Particles that came and went: emitted, drained, expired, ...")
      .def_prop_ro(
          "lost_momentum", [](const NamedReport& r) { return lost_momentum_of(r.report); },
          nb::sig("def lost_momentum(self) -> dict[str, float]"),
          "Momentum that filter, guards and sleep took from objects [kg m/s].");
  bind_happenings(c);
  bind_mapping(c);
}

}  // namespace pliant::python
