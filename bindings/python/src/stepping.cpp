// Steps of a World, without the GIL: pliant.World.step, run, frames, state.

#include <chrono>
#include <cmath>

#include "pliant/error.h"
#include "world.h"

namespace pliant::python {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// A step that took longer is ended by Ctrl-C before it is complete [ms].
constexpr double long_step = 20;

/// The number of frames to run: that of the caller, or the scene's own.
int valid_frames(const OwnedWorld& owned, std::optional<int> frames) {
  const int count = frames.value_or(owned.file().scene.frames);
  if (count < 1) throw Error({}, "frames is " + std::to_string(count), "run 1 or more");
  return count;
}

/// Restores while another exception passes on, which tells more than one of restoring.
void restore_quietly(World& world, const State& state) noexcept {
  try {
    world.restore(state);
  } catch (...) {  // the World stays stopped, and its next Report says so
    return;
  }
}

/// Runs frames without the GIL; looks for signals every few milliseconds.
NamedReport run(OwnedWorld& owned, int frames) {
  Stepping stepping(owned);
  const StopOnInterrupt guard(owned.stop, true);
  NamedReport result{{}, owned.names()};
  auto looked = Clock::now();
  for (int done = 0; done < frames && result.report.ok() && !result.report.stopped;) {
    {
      const nb::gil_scoped_release release;
      do {
        result.report = stepping.advance(owned.frame_time());
        ++done;
      } while (done < frames && result.report.ok() && !result.report.stopped && milliseconds_since(looked) < long_step);
    }
    looked = Clock::now();
    owned.answer(result.report);
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
  owned.last_milliseconds = result.report.milliseconds;
  return result;
}

NamedReport step_once(const WorldRef& self, nb::handle dt) {
  return step(*self.world, dt.is_none() ? self.world->frame_time() : time_step_from(dt));
}

/// Iterates over frames: each next() steps once.
struct Frames {
  SharedWorld world;
  int left = 0;
};

NamedReport next_frame(Frames& frames) {
  if (frames.left <= 0) throw nb::stop_iteration();
  --frames.left;
  NamedReport report = step(*frames.world, frames.world->frame_time());
  if (!report.report.ok() || report.report.stopped) frames.left = 0;
  return report;
}

}  // namespace

float time_step_from(nb::handle dt) {
  const auto value = static_cast<float>(number_from(dt, "dt"));
  if (!(value > 0) || !std::isfinite(value))
    throw Error({}, "dt is " + repr_of(dt) + " s", "pass a finite number of float32 above 0");
  return value;
}

Stepping::Stepping(OwnedWorld& owned) : owned_(owned) {
  owned.idle();
  owned_.is_stepping_ = true;
  owned_.stop = owned_.is_asked_to_stop_;
}

void OwnedWorld::ask_to_stop() { stop = is_asked_to_stop_ = true; }

void OwnedWorld::answer(const Report& report) {
  if (report.stopped) stop = is_asked_to_stop_ = false;
}

Report Stepping::advance(float dt) {
  World& world = owned_.world_;
  const std::int64_t before = world.state().frame;
  const bool has_forces = !owned_.forces_.empty();
  if (has_forces) owned_.before_ = world.state();
  Report report;
  try {
    report = world.step(dt);
  } catch (...) {  // of a force, during a substep; objects come apart after the last one, so that the State fits
    if (has_forces) restore_quietly(world, owned_.before_);
    throw;
  }
  for (const Torn& torn : report.torn) ++owned_.changes_[torn.object];
  if (report.ok() && !report.stopped && world.state().frame == before)
    throw Error({}, report.explain(), "pass a longer one");
  return report;
}

NamedReport step(OwnedWorld& owned, float dt) {
  NamedReport result{{}, owned.names()};
  Stepping stepping(owned);
  {
    const StopOnInterrupt guard(owned.stop, owned.last_milliseconds > long_step);
    const nb::gil_scoped_release release;
    result.report = stepping.advance(dt);
  }
  owned.answer(result.report);
  owned.last_milliseconds = result.report.milliseconds;
  if (result.report.stopped && PyErr_CheckSignals() != 0) throw nb::python_error();
  return result;
}

void bind_stepping(nb::module_& m, nb::class_<WorldRef>& c) {
  nb::class_<Frames>(m, "_Frames", nb::type_slots(collected_slots<Frames>()), "What World.frames() returns.")
      .def("__iter__", [](nb::handle self) { return nb::borrow(self); })
      .def("__next__", &next_frame);
  c.def("step", &step_once, nb::arg("dt") = nb::none(), nb::sig("def step(self, dt: float | None = None) -> Report"),
        "Advances by one frame of `dt` seconds; None: the scene's frame_time. Does not raise for values that are not "
        "finite: see Report.ok. Raises Error if dt is too short for its substeps, and what a force function raises: "
        "then the World is back at the State before this step, as by restore(). Keep dt constant. Other Python threads "
        "run meanwhile. Ctrl-C ends a long step within a substep; the frame then does not count.")
      .def(
          "run",
          [](const WorldRef& self, std::optional<int> frames) {
            return run(*self.world, valid_frames(*self.world, frames));
          },
          nb::arg("frames") = nb::none(), nb::sig("def run(self, frames: int | None = None) -> Report"),
          "Runs frames, the scene's own number if None, and returns the last Report. Ends early where Report.ok is "
          "false.")
      .def(
          "frames",
          [](const WorldRef& self, std::optional<int> count) {
            return Frames{self.world, valid_frames(*self.world, count)};
          },
          nb::arg("count") = nb::none(),
          nb::sig("def frames(self, count: int | None = None) -> collections.abc.Iterator[Report]"),
          "Iterates over frames: each steps once and gives its Report. None: the scene's own number. Ends after a "
          "Report that is not ok.")
      .def(
          "stop", [](const WorldRef& self) { self.world->ask_to_stop(); },
          "Ends a step that runs in another thread within a substep: its Report has `stopped`. If none runs, the next "
          "one ends before it begins. A Report that has `stopped` ends the effect.")
      .def(
          "forget_forces", [](const WorldRef& self) { self.world->forget_forces(); },
          "Forgets the functions of `forces`; later steps are without them. The World still cannot be pickled, copied "
          "or "
          "saved: make another, and give it this one's state().")
      .def(
          "state", [](const WorldRef& self) { return self.world->idle().state(); }, "A copy of the State.")
      .def(
          "restore", [](const WorldRef& self, const State& state) { self.world->changing("restored").restore(state); },
          nb::arg("state"), "Restores a State of this World. Raises Error if it does not fit.")
      .def(
          "state_hash", [](const WorldRef& self) { return self.world->idle().state_hash(); },
          "The SHA-256 hash of the State: the same on every machine and by any number of threads.");
}

}  // namespace pliant::python
