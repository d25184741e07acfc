// Writes USD as text: one prim for each object under /World, its points as time samples. Rigid bodies are prims that
// move (write_usda_bodies.h).
//
// A time code is a frame number, so that tools show integers; samples at other times are between these. The text has
// all samples of a prim together, so each object has a Spool of its own until the end.
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "pliant/error.h"
#include "usda_text.h"
#include "write_frames.h"
#include "write_spool.h"
#include "write_usda_bodies.h"

namespace pliant::output {

namespace {

/// The prim of an object: its points in the prim's order, and the samples so far.
class Prim {
 public:
  Prim(const Destination& to, const FrameObject& object) : object_(object), points_(to), extents_(to) {
    if (object.is_remeshed) counts_.emplace(to), indices_.emplace(to);
    if (object.is_relinked) counts_.emplace(to);
    order_by(object.lines);
  }

  /// Of an object that is relinked: the lines at that time, before its positions.
  void add_lines(const std::string& time, const std::vector<std::vector<int>>& lines) {
    order_by(lines);
    counts_->write("            " + time + ": " + counts_of(lines) + ",\n");
  }

  void add(const std::string& time, const std::vector<Vec3f>& positions) {
    const std::vector<Vec3f>& points = curves() ? arranged(positions) : positions;
    points_.write("            " + time + ": " + listed(points, tuple) + ",\n");
    extents_.write("            " + time + ": " + extent(points, object_.is_surface() ? 0 : object_.width / 2) + ",\n");
  }

  /// Of an object that is remeshed: the triangles at that time.
  void add_mesh(const std::string& time, const std::vector<std::array<int, 3>>& triangles) {
    counts_->write("            " + time + ": " + counts_of(triangles) + ",\n");
    indices_->write("            " + time + ": " + indices_of(triangles) + ",\n");
  }

  void write(OutputFile& file, const std::string& name) {
    file.write("\n    def " + std::string(type()) + " \"" + name + "\" (\n        doc = " + usda_string(object_.name) +
               "\n    )\n    {\n");
    file.write(topology());
    if (object_.is_remeshed) {
      write_samples(file, "int[] faceVertexCounts", *counts_);
      write_samples(file, "int[] faceVertexIndices", *indices_);
    }
    if (object_.is_relinked) write_samples(file, "int[] curveVertexCounts", *counts_);
    std::string colour;
    tuple(colour, object_.colour);
    file.write("        color3f[] primvars:displayColor = [" + colour + "]\n");
    write_samples(file, "float3[] extent", extents_);
    write_samples(file, "point3f[] points", points_);
    file.write("    }\n");
  }

 private:
  bool curves() const { return !object_.is_surface() && !object_.lines.empty(); }
  const char* type() const { return curves() ? "BasisCurves" : object_.is_surface() ? "Mesh" : "Points"; }

  static void write_samples(OutputFile& file, const std::string& attribute, Spool& samples) {
    file.write("        " + attribute + ".timeSamples = {\n");
    samples.copy_to(file);
    file.write("        }\n");
  }

  static std::string listed_numbers(const std::vector<int>& numbers) {
    return listed(numbers, [](std::string& text, int i) { append(text, i); });
  }
  static std::string counts_of(const std::vector<std::array<int, 3>>& triangles) {
    return listed_numbers(std::vector<int>(triangles.size(), 3));
  }
  static std::string indices_of(const std::vector<std::array<int, 3>>& triangles) {
    std::vector<int> indices;
    for (const auto& triangle : triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
    return listed_numbers(indices);
  }

  static std::string counts_of(const std::vector<std::vector<int>>& lines) {
    std::vector<int> counts;
    counts.reserve(lines.size());
    for (const auto& line : lines) counts.push_back(static_cast<int>(line.size()));
    return listed_numbers(counts);
  }

  void order_by(const std::vector<std::vector<int>>& lines) {
    order_.clear();
    for (const auto& line : lines) order_.insert(order_.end(), line.begin(), line.end());
  }

  const std::vector<Vec3f>& arranged(const std::vector<Vec3f>& positions) {
    arranged_.clear();
    for (const int i : order_) arranged_.push_back(positions[i]);
    return arranged_;
  }

  std::string topology() const {
    if (object_.is_surface()) {
      std::string text = "        uniform bool doubleSided = 1\n        uniform token subdivisionScheme = \"none\"\n";
      if (object_.is_remeshed) return text;
      text += "        int[] faceVertexCounts = " + counts_of(object_.triangles) + "\n";
      return text + "        int[] faceVertexIndices = " + indices_of(object_.triangles) + "\n";
    }
    std::string widths = "        float[] widths = [";
    append(widths, object_.width);
    widths += "] (\n            interpolation = \"constant\"\n        )\n";
    if (!curves()) return widths;
    const std::string counts =
        object_.is_relinked ? "" : "        int[] curveVertexCounts = " + counts_of(object_.lines) + "\n";
    return "        uniform token type = \"linear\"\n" + counts + widths;
  }

  FrameObject object_;
  std::vector<int> order_;
  std::vector<Vec3f> arranged_;
  Spool points_, extents_;
  std::optional<Spool> counts_, indices_;  // of triangles, or counts of lines, where each frame has others
};

/// The shortest decimal frame rate whose inverse is `frame_time` as a float: 60, where 1 / 0.016666668 is 59.999997.
double frames_per_second(double frame_time) {
  const double rate = 1 / frame_time;
  for (double digits = 1; digits < 1e6; digits *= 10) {
    const double rounded = std::round(digits * rate) / digits;
    if (rounded > 0 && static_cast<float>(1 / rounded) == static_cast<float>(frame_time)) return rounded;
  }
  return std::round(1e6 * rate) / 1e6;
}

class UsdaWriter final : public FormatWriter {
 public:
  UsdaWriter(const Destination& to, Objects objects, double frame_time)
      : path_(to.path),
        objects_(std::move(objects)),
        frame_time_(frame_time > 0 ? frame_time : 1. / 60),
        file_(to.open(to.path)) {
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      if (objects_[o].has_matter()) prims_.emplace_back(to, objects_[o]), prim_objects_.push_back(o);
      if (!objects_[o].bodies.empty()) bodies_.emplace_back(objects_[o]), body_objects_.push_back(o);
    }
  }

  void add(const Frame& frame) override {
    check_frame(path_, objects_, frame, last_time_);
    std::string text;
    append(text, time_code(frame.time));
    if (first_code_.empty()) first_code_ = text;
    last_code_ = text;
    last_time_ = frame.time;
    for (std::size_t p = 0; p < prims_.size(); ++p) {
      const std::size_t o = prim_objects_[p];
      if (objects_[o].is_relinked) prims_[p].add_lines(text, frame.lines[o]);
      prims_[p].add(text, frame.positions[o]);
      if (objects_[o].is_remeshed) prims_[p].add_mesh(text, frame.triangles[o]);
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b].add(text, frame.bodies[body_objects_[b]]);
  }

  void finish() override {
    if (std::exchange(finished_, true)) return;
    if (first_code_.empty())
      throw Error({.file = path_, .line = 0, .object = {}, .element = {}}, "there are no frames to write",
                  "add one before finishing");
    std::string rate;
    append(rate, frames_per_second(frame_time_));
    file_->write("#usda 1.0\n(\n    defaultPrim = \"World\"\n    startTimeCode = " + first_code_ +
                 "\n    endTimeCode = " + last_code_ + "\n    timeCodesPerSecond = " + rate +
                 "\n    framesPerSecond = " + rate +
                 "\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\ndef Xform \"World\"\n{");
    std::vector<std::string> names;
    for (const auto* indices : {&prim_objects_, &body_objects_})
      for (const std::size_t o : *indices) names.push_back(objects_[o].name);
    names = identifiers(names);
    for (std::size_t p = 0; p < prims_.size(); ++p) prims_[p].write(*file_, names[p]);
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b].write(*file_, names[prims_.size() + b]);
    file_->write("}\n");
    commit(*file_);
  }

 private:
  /// The time code of a time: an integer, up to rounding, if the steps of the run have the frame time.
  double time_code(double time) const {
    const double code = time / frame_time_, whole = std::round(code);
    return std::abs(code - whole) < 1e-3 ? whole : code;
  }

  std::string path_;
  Objects objects_;
  double frame_time_;
  std::unique_ptr<OutputFile> file_;
  std::vector<Prim> prims_;
  std::vector<UsdaBodies> bodies_;
  std::vector<std::size_t> prim_objects_, body_objects_;  // indices of their objects
  std::string first_code_, last_code_;
  bool finished_ = false;
  double last_time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<FormatWriter> make_usda_writer(const Destination& to, const Objects& objects, double frame_time) {
  return std::make_unique<UsdaWriter>(to, objects, frame_time);
}

}  // namespace pliant::output
