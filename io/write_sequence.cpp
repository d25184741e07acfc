// Writes one file per frame: NAME_0000.obj or NAME_0000.ply, with all objects in each.
//
// OBJ separates objects by `o`. PLY has no objects, so each vertex has the colour and the index of its object.
#include <cmath>
#include <limits>
#include <utility>

#include "write_frames.h"
#include "write_obj.h"
#include "write_text.h"

namespace pliant::output {

namespace {

class SequenceWriter : public FormatWriter {
 public:
  SequenceWriter(const Destination& to, Objects objects)
      : split_(split_path(to.path)), to_(to), objects_(std::move(objects)) {}

  void add(const Frame& frame) final {
    check_frame(to_.path, objects_, frame, last_time_);
    const std::unique_ptr<OutputFile> file =
        to_.open(split_.stem + "_" + frame_number(frame.number) + to_.path.substr(split_.stem.size()));
    write(*file, frame);
    commit(*file);
    last_time_ = frame.time;
  }

  void finish() final {}

 protected:
  virtual void write(OutputFile& file, const Frame& frame) = 0;
  const Objects& objects() const { return objects_; }

 private:
  SplitPath split_;
  Destination to_;
  Objects objects_;
  double last_time_ = -std::numeric_limits<double>::infinity();
};

class ObjSequence final : public SequenceWriter {
 public:
  ObjSequence(const Destination& to, const Objects& objects)
      : SequenceWriter(to, objects), elements_(elements(objects)) {}

 private:
  /// The faces, lines and points of each object as text, which is the same in every frame.
  static std::vector<std::string> elements(const Objects& objects) {
    std::vector<std::string> result;
    int first = 1;
    for (const FrameObject& object : objects) {
      result.push_back(obj_elements(object, first));
      first += object.particles;
    }
    return result;
  }

  void write(OutputFile& file, const Frame& frame) override {
    std::string text = "# time ";
    append(text, frame.time);
    file.write(text + " s, lengths in metres\n");
    const std::vector<std::string> names = identifiers(objects());
    if (is_any_varying(objects())) elements_ = elements(present_objects(objects(), frame));
    for (std::size_t o = 0; o < objects().size(); ++o) {
      file.write("o " + names[o] + "\n" + obj_vertices(frame.positions[o]));
      file.write(elements_[o]);
    }
  }

  std::vector<std::string> elements_;
};

std::array<unsigned char, 3> bytes(const Vec3f& linear) {
  const auto one = [](float c) {
    const double clamped = c < 0 ? 0 : c > 1 ? 1 : c;
    const double encoded = clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * std::pow(clamped, 1 / 2.4) - 0.055;
    return static_cast<unsigned char>(encoded * 255 + 0.5);
  };
  return {one(linear.x), one(linear.y), one(linear.z)};
}

class PlySequence final : public SequenceWriter {
 public:
  PlySequence(const Destination& to, const Objects& objects) : SequenceWriter(to, objects) { describe(objects); }

 private:
  /// Makes the header, the faces and the edges, which are the same in every frame unless an object is remeshed.
  void describe(const Objects& objects) {
    face_bytes_.clear(), edge_bytes_.clear();
    faces_ = edges_ = 0;
    int first = 0;
    for (const FrameObject& object : objects) {
      add_elements(object, first);
      first += object.particles;
    }
    header_ = "ply\nformat binary_little_endian 1.0\ncomment lengths in metres\n";
    header_ += "element vertex " + std::to_string(first) + "\nproperty float x\nproperty float y\nproperty float z\n";
    header_ += "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int object\n";
    header_ += "element face " + std::to_string(faces_) + "\nproperty list uchar int vertex_indices\n";
    if (edges_ > 0)
      header_ += "element edge " + std::to_string(edges_) + "\nproperty int vertex1\nproperty int vertex2\n";
    header_ += "end_header\n";
  }

  static void put(std::string& bytes, int value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }

  void add_elements(const FrameObject& object, int first) {
    for (const auto& triangle : object.triangles) {
      face_bytes_ += '\3';
      for (const int i : triangle) put(face_bytes_, first + i);
    }
    faces_ += object.triangles.size();
    if (!object.triangles.empty()) return;
    for (const auto& line : object.lines) {
      for (std::size_t i = 0; i + 1 < line.size(); ++i, ++edges_) {
        put(edge_bytes_, first + line[i]);
        put(edge_bytes_, first + line[i + 1]);
      }
    }
  }

  void write(OutputFile& file, const Frame& frame) override {
    if (is_any_varying(objects())) describe(present_objects(objects(), frame));
    file.write(header_);
    for (std::size_t o = 0; o < objects().size(); ++o) {
      const auto colour = bytes(objects()[o].colour);
      for (const Vec3f& position : frame.positions[o]) {
        file.write_value(position);
        file.write(colour.data(), colour.size());
        file.write_value(static_cast<int>(o));
      }
    }
    file.write(face_bytes_);
    file.write(edge_bytes_);
  }

  std::string header_, face_bytes_, edge_bytes_;
  std::size_t faces_ = 0, edges_ = 0;
};

}  // namespace

std::unique_ptr<FormatWriter> make_obj_sequence(const Destination& to, const Objects& objects) {
  return std::make_unique<ObjSequence>(to, objects);
}

std::unique_ptr<FormatWriter> make_ply_sequence(const Destination& to, const Objects& objects) {
  return std::make_unique<PlySequence>(to, objects);
}

}  // namespace pliant::output
