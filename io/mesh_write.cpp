// Writes a mesh: OBJ as text, PLY as little-endian binary. Text has the fewest digits that read back as the same float,
// so nothing is lost.
#include <cmath>
#include <cstdint>
#include <utility>

#include "atomic_file.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "shortest_number.h"

namespace pliant {

namespace {

[[noreturn]] void refuse_mesh(const std::string& path, std::string element, std::string problem, std::string advice) {
  throw Error({.file = path, .line = 0, .object = {}, .element = std::move(element)}, std::move(problem),
              std::move(advice));
}

bool ends_with(const std::string& text, const char* suffix, std::size_t length) {
  if (text.size() < length) return false;
  for (std::size_t i = 0; i < length; ++i) {
    const char c = text[text.size() - length + i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != suffix[i]) return false;
  }
  return true;
}

/// Throws an Error for a mesh that read_mesh would reject.
void check(const std::string& path, const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3f& p = mesh.positions[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      refuse_mesh(path, "vertex " + std::to_string(i), "is not finite, so nothing was written",
                  "find where the simulation diverged");
  }
  const std::size_t count = mesh.positions.size();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const int corner : mesh.triangles[i])
      if (corner < 0 || static_cast<std::size_t>(corner) >= count)
        refuse_mesh(path, "triangle " + std::to_string(i),
                    "uses vertex " + std::to_string(corner) + " but there are " + std::to_string(count),
                    "correct the mesh");
}

class Line {
 public:
  explicit Line(char keyword) { *end_++ = keyword; }
  template <class Number>
  Line& add(Number number) {
    *end_++ = ' ';
    end_ = write_shortest(end_, text_ + sizeof text_ - 1, number);
    return *this;
  }
  void write_to(AtomicFile& file) {
    *end_++ = '\n';
    file.write(text_, static_cast<std::size_t>(end_ - text_));
  }

 private:
  char text_[80];  // a keyword and three numbers of up to 16 characters
  char* end_ = text_;
};

void write_obj(AtomicFile& file, const TriangleMesh& mesh) {
  for (const Vec3f& p : mesh.positions) Line('v').add(p.x).add(p.y).add(p.z).write_to(file);
  for (const auto& t : mesh.triangles)
    Line('f').add(std::int64_t{t[0]} + 1).add(std::int64_t{t[1]} + 1).add(std::int64_t{t[2]} + 1).write_to(file);
}

void write_ply(AtomicFile& file, const TriangleMesh& mesh) {
  file.write("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
             "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
             std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n");
  for (const Vec3f& p : mesh.positions) {
    file.write_value(p.x);
    file.write_value(p.y);
    file.write_value(p.z);
  }
  for (const auto& t : mesh.triangles) {
    file.write_value(std::uint8_t{3});
    for (const int corner : t) file.write_value(static_cast<std::int32_t>(corner));
  }
}

}  // namespace

void write_mesh(const std::string& path, const TriangleMesh& mesh) {
  const bool is_obj = ends_with(path, ".obj", 4);
  if (!is_obj && !ends_with(path, ".ply", 4))
    refuse_mesh(path, {}, "has a suffix without a mesh format", "name it .obj or .ply");
  check(path, mesh);
  AtomicFile file(path);
  if (is_obj)
    write_obj(file, mesh);
  else
    write_ply(file, mesh);
  file.commit();
}

}  // namespace pliant
