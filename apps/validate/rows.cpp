// Functions that make rows of the table, and small scenes.
#include "apps/validate/rows.h"

#include <cmath>
#include <cstdio>
#include <limits>

namespace pliant::validate {
namespace {

Row make(std::string name, double expected, double measured, double tolerance, Comparison how, std::string unit,
         std::string note) {
  Row row{std::move(name), expected, measured, tolerance, how, std::move(unit), false, std::move(note)};
  const double away = std::abs(measured - expected);
  if (how == Comparison::relative) row.pass = away <= tolerance * std::abs(expected);
  if (how == Comparison::absolute) row.pass = away <= tolerance;
  if (how == Comparison::at_most) row.pass = measured <= expected;
  if (how == Comparison::at_least) row.pass = std::isfinite(measured) && measured >= expected;
  return row;
}

}  // namespace

Row relative(std::string name, double expected, double measured, double tolerance, std::string unit, std::string note) {
  return make(std::move(name), expected, measured, tolerance, Comparison::relative, std::move(unit), std::move(note));
}

Row absolute(std::string name, double expected, double measured, double tolerance, std::string unit, std::string note) {
  return make(std::move(name), expected, measured, tolerance, Comparison::absolute, std::move(unit), std::move(note));
}

Row at_most(std::string name, double bound, double measured, std::string unit, std::string note) {
  return make(std::move(name), bound, measured, 0, Comparison::at_most, std::move(unit), std::move(note));
}

Row at_least(std::string name, double bound, double measured, std::string unit, std::string note) {
  return make(std::move(name), bound, measured, 0, Comparison::at_least, std::move(unit), std::move(note));
}

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

double farthest(double expected, const std::vector<double>& measured) {
  double worst = expected;
  for (double value : measured) {
    if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
    if (std::abs(value - expected) >= std::abs(worst - expected)) worst = value;
  }
  return worst;
}

Object particles(const std::vector<Vec3f>& positions, const std::vector<float>& masses) {
  Object object;
  object.name = "particles";
  object.positions = positions;
  object.masses = masses;
  return object;
}

void connect(Object& object, const std::vector<int>& pairs, const std::vector<float>& lengths,
             const Stiffness& stiffness) {
  ConstraintGroup group;
  group.type = "distance";
  group.particles = pairs;
  group.rest = lengths;
  group.stiffness = stiffness;
  object.constraints.push_back(group);
}

Object hanging_line(int count, float length, float mass, float last_mass, const Stiffness& stiffness) {
  std::vector<Vec3f> positions;
  std::vector<float> masses(static_cast<std::size_t>(count), mass);
  std::vector<int> pairs;
  for (int i = 0; i < count; ++i) {
    positions.push_back({0, -length * static_cast<float>(i), 0});
    if (i > 0) pairs.insert(pairs.end(), {i - 1, i});
  }
  masses.front() = std::numeric_limits<float>::infinity();
  masses.back() = last_mass;
  Object object = particles(positions, masses);
  connect(object, pairs, std::vector<float>(pairs.size() / 2, length), stiffness);
  return object;
}

Scene scene_with(Object object, double g, int substeps, int iterations) {
  Scene scene;
  scene.gravity = {0, static_cast<float>(-g), 0};
  scene.settings.sweep = Sweep::tiled;
  scene.settings.substeps = substeps;
  scene.settings.iterations = iterations;
  scene.settings.threads = 1;
  scene.add(std::move(object));
  return scene;
}

double Random::uniform(double low, double high) {
  state_ = state_ * 48271 % 2147483647;
  return low + (high - low) * static_cast<double>(state_) / 2147483647.0;
}

}  // namespace pliant::validate
