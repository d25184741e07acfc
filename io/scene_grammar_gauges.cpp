// The part of the table for gauges of liquids.
#include "pliant/gauges.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

const Record& height_record() {
  static const Record result{"height gauge",
                             "The volume of liquid inside an axis-aligned box, over the area of its base, in m.",
                             {needed("min", place(), "Its low corner."),
                              needed("max", place(), "Its high corner, above `min` in each coordinate."),
                              field("axis", choice({"x", "y", "z"}), "y", "Up: the base is across this axis.")},
                             {}};
  return result;
}

const Record& flow_record() {
  static const Record result{
      "flow gauge",
      "The volume of liquid that passes through a parallelogram, in m^3/s, averaged over the frame.",
      {needed("corner", place(), "One of its corners."), needed("side_a", place(), "A side from there."),
       needed("side_b", place(),
              "The other side from there. Flow in the direction of `side_a` x `side_b` is positive.")},
      {}};
  return result;
}

const Record& front_record() {
  static const Record result{
      "front gauge",
      "The place along a direction that a share of the liquid is behind, in m from the origin.",
      {field("direction", vector("-", largest_place), FrontGauge{}.direction, "Any length but zero."),
       field("share", share(), FrontGauge{}.share, "Share of the volume, above 0 and below 1.")},
      {}};
  return result;
}

const Record& force_record() {
  static const Record result{
      "force gauge",
      "The force with which liquid presses on something, in N, averaged over the frame; without friction.",
      {needed("on", string(), "Name of a collider, or of an object that is no liquid."),
       field("direction", vector("-", largest_place), ForceGauge{}.direction, "A force along it is positive.")},
      {}};
  return result;
}

}  // namespace

const Record& gauge_record() {
  static const Record result{
      "gauge",
      "A measurement of liquids, which `pliant run --gauges FILE` writes for each frame (docs/guide/liquids.md).",
      {needed("name", string(), "Unique name: the heading of its column."),
       either("height", record(height_record()), "The height over a footprint."),
       either("flow", record(flow_record()), "The volume per second through an opening."),
       either("front", record(front_record()), "The front of a wave."),
       either("force", record(force_record()), "The force on a collider or a body."),
       field("liquids", list(string(), 1), "all", "Names of the liquids that it measures.")},
      {"height", "flow", "front", "force"}};
  return result;
}

}  // namespace pliant::scene_file
