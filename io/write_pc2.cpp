// Writes NAME.pc2, a point cache, and NAME.obj, the mesh that it animates.
//
// The cache is one sequence of points, so all objects share one .obj, as groups (`g`) instead of objects (`o`):
// importers divide a file at `o`, and its parts would not fit the cache. Layout of the cache: "POINTCACHE2\0", int
// version 1, int points, float start frame, float frames per sample, int samples, then the samples.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include "pliant/error.h"
#include "write_frames.h"
#include "write_obj.h"

namespace pliant::output {

namespace {

constexpr const char* first_words = "# the mesh that ";

/// Throws an Error if NAME.obj exists and this program did not write it: it could be the mesh that the scene reads.
void refuse_foreign_mesh(const std::string& path, const std::string& mesh) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(mesh, unknown)) return;  // AtomicFile reports whether it can be made
  std::ifstream in(mesh, std::ios::binary);
  const std::string expected = first_words;
  std::string found(expected.size(), '\0');
  in.read(found.data(), static_cast<std::streamsize>(found.size()));
  if (in.gcount() == 0 || found == expected) return;
  throw Error({.file = path, .line = 0, .object = {}, .element = {}},
              "its mesh would overwrite " + mesh + ", which does not belong to a point cache",
              "give the cache another name");
}

class Pc2Writer final : public FormatWriter {
 public:
  Pc2Writer(const Destination& to, Objects objects)
      : to_(to), objects_(std::move(objects)), file_(to.open(to.path)), mesh_path_(split_path(to.path).stem + ".obj") {
    if (to_.is_disk()) refuse_foreign_mesh(to_.path, mesh_path_);
    std::int32_t points = 0;
    for (const FrameObject& object : objects_) points += object.particles;
    file_->write("POINTCACHE2", 12);
    file_->write_value(std::int32_t{1});
    file_->write_value(points);
    file_->write_value(0.f);
    file_->write_value(1.f);
    samples_at_ = file_->size();
    file_->write_value(std::int32_t{0});
  }

  void add(const Frame& frame) override {
    check_frame(to_.path, objects_, frame, last_time_);
    if (samples_ == 0) mesh_ = mesh(frame);
    for (const std::vector<Vec3f>& positions : frame.positions)
      file_->write(positions.data(), positions.size() * sizeof(Vec3f));
    last_time_ = frame.time;
    ++samples_;
  }

  void finish() override {
    if (std::exchange(finished_, true)) return;
    if (samples_ == 0)
      throw Error({.file = to_.path, .line = 0, .object = {}, .element = {}}, "there are no frames to write",
                  "add one before finishing");
    file_->overwrite(samples_at_, &samples_, sizeof samples_);
    const std::unique_ptr<OutputFile> mesh = to_.open(mesh_path_);
    mesh->write(mesh_);
    commit(*file_);
    commit(*mesh);
  }

 private:
  std::string mesh(const Frame& frame) const {
    std::string text = first_words + file_name(to_.path) + " moves, at its first sample\n";
    for (const std::vector<Vec3f>& positions : frame.positions) text += obj_vertices(positions);
    const std::vector<std::string> names = identifiers(objects_);
    int first = 1;
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      text += "g " + names[o] + "\n" + obj_elements(objects_[o], first);
      first += objects_[o].particles;
    }
    return text;
  }

  Destination to_;
  Objects objects_;
  std::unique_ptr<OutputFile> file_;
  std::string mesh_path_;
  std::string mesh_;  // text of the .obj, kept so that both files are replaced together
  std::size_t samples_at_ = 0;
  std::int32_t samples_ = 0;
  bool finished_ = false;
  double last_time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<FormatWriter> make_pc2_writer(const Destination& to, const Objects& objects, double) {
  return std::make_unique<Pc2Writer>(to, objects);
}

}  // namespace pliant::output
