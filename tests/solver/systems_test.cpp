// Tests that a new kind of matter takes part in a step as a System alone, without a change of the solver.
#include "solver/systems/systems.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "solver/step.h"
#include "solver/step_support.h"
#include "solver/substep.h"
#include "solver/substep_group.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A membrane at a height: particles stay above it, and those that come down on it lose their speed, but for an updraft
/// that lifts all.
class Membrane : public System {
 public:
  Membrane(float height, float updraft, std::string& log) : height_(height), updraft_(updraft), log_(log) {}

  void begin_frame(Substep& /*s*/) override { log_ += "begin "; }
  void control(Substep& /*s*/) override { log_ += "control "; }
  bool changes_velocities() const override { return true; }
  void apply_forces(Substep& s) override {
    log_ += "forces ";
    for (Record& v : s.state.velocities) v.y += updraft_ * s.h;
  }
  void collide(Substep& s) override {
    log_ += "collide ";
    touching_ = 0;
    for (int i = 0; i < static_cast<int>(s.state.positions.size()); ++i)
      touching_ += predicted_position(s, i).y < height_ ? 1 : 0;
  }
  void project_neighbours(Substep& /*s*/, bool /*is_first*/) override { log_ += "neighbours "; }
  void project(Substep& s, bool /*is_first*/) override {
    log_ += "project ";
    for (int i = 0; i < static_cast<int>(s.state.positions.size()); ++i) {
      const float depth = height_ - predicted_position(s, i).y;
      if (depth > 0) s.work.displacements[at(i)].y += depth;
    }
  }
  void stop_passing(Substep& /*s*/) override { log_ += "passing "; }
  void end_filter(Substep& /*s*/) override { log_ += "filter "; }
  void respond(Substep& s, FunctionRef<Vec3f(int)> /*gravity*/) override {
    log_ += "respond ";
    for (int i = 0; i < static_cast<int>(s.state.positions.size()); ++i)
      if (s.state.positions[at(i)].y <= height_) s.state.velocities[at(i)].y = 0;
  }
  void count_contacts(Report& report) const override { report.contacts += touching_; }
  void end_frame(Substep& /*s*/) override { log_ += "end "; }
  void order(State& /*state*/) const override { log_ += "order "; }
  void report(Report& report) const override { report.warnings.push_back("a membrane"); }

 private:
  float height_, updraft_;
  int touching_ = 0;
  std::string& log_;
};

/// Two particles that fall.
Model two_particles() {
  Object object;
  object.name = "drops";
  object.positions = {{0, 1, 0}, {0.5f, 3, 0}};
  object.masses = {1, 1};
  Model model;
  model.gravity = {0, -9.81f, 0};
  model.add(compile(object, {1, 4096}));
  return model;
}

struct Stepped {
  State state;
  Report report;
  std::string log;
};

Stepped step_with_membrane(int substeps, int frames, float updraft) {
  const Model model = two_particles();
  Stepped out{initial_state(model), {}, {}};
  Workspace workspace;
  prepare(model, Multipliers::none, workspace);
  prepare_sweeps(model, Settings{}, 1, workspace);
  SubstepGroup group = group_of_all(model, substeps);
  group.systems.add(std::make_unique<Membrane>(0.9f, updraft, out.log));
  const std::vector<GroupFrame> groups{{&group, substeps}};
  Executor executor(1);
  StepContext context{model, out.state, workspace, executor, kernels_sequential(), substeps, 1};
  context.groups = groups;
  for (int frame = 0; frame < frames; ++frame) {
    out.report = {};
    step(context, 1. / 60, out.report);
  }
  return out;
}

TEST(Systems, AreCalledInTheOrderOfAFrame) {
  const std::string substep = "control forces collide neighbours project passing filter respond ";
  EXPECT_EQ(step_with_membrane(2, 1, 0).log, "begin " + substep + substep + "end order ");
}

TEST(Systems, HoldWhatTheyProject) {
  const Stepped found = step_with_membrane(10, 120, 0);
  for (const Record& p : found.state.positions) EXPECT_NEAR(p.y, 0.9f, 1e-5f);
  EXPECT_EQ(found.report.contacts, 2);
  ASSERT_EQ(found.report.warnings.size(), 1u);
  EXPECT_EQ(found.report.warnings[0], "a membrane");
}

/// Both fall with g - 4 m/s^2 for 0.1 s.
TEST(Systems, ChangeVelocities) {
  const Stepped found = step_with_membrane(10, 6, 4);
  EXPECT_NEAR(found.state.velocities[1].y, -0.581f, 1e-4f);
}

}  // namespace
}  // namespace pliant
