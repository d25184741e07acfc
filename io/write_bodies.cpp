// Rigid bodies for writers: the surfaces that they share, their motions, and their vertices for formats without bodies.
#include "write_bodies.h"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "pliant/body.h"
#include "pliant/error.h"

namespace pliant::output {

namespace {

/// The bytes that determine the surface of solids; bodies with equal bytes share it.
class SolidKey {
 public:
  explicit SolidKey(const std::vector<Solid>& solids) {
    for (const Solid& solid : solids) {
      const std::size_t kind = solid.shape.index();
      text_.append(reinterpret_cast<const char*>(&kind), sizeof kind);
      std::visit(*this, solid.shape);
      put(solid.position);
      put({solid.rotation.x, solid.rotation.y, solid.rotation.z});
      put(solid.rotation.w);
    }
  }

  void operator()(const Sphere& s) { put(s.radius); }
  void operator()(const Capsule& s) { put(s.radius), put(s.half_length); }
  void operator()(const Box& s) { put(s.half_extents); }
  void operator()(const Cylinder& s) { put(s.radius), put(s.half_length); }
  void operator()(const Cone& s) { put(s.radius), put(s.half_length); }
  void operator()(const Hull& s) {
    put(static_cast<float>(s.points.size())), put(s.margin);
    for (const Vec3f& point : s.points) put(point);
  }

  const std::string& text() const { return text_; }

 private:
  void put(float value) { text_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void put(const Vec3f& v) { put(v.x), put(v.y), put(v.z); }

  std::string text_;
};

/// Segments of round solids: with many bodies in a file or picture each is small.
int segments_for(std::size_t bodies) { return bodies > 500 ? 16 : 32; }

Vec3f vertex_velocity(const BodyMotion& motion, const Vec3f& arm) {
  return motion.velocity + cross(motion.angular_velocity, arm);
}

/// Gives a format without bodies their surfaces instead: those of an object are one more object.
class SurfaceWriter final : public FormatWriter {
 public:
  SurfaceWriter(Objects objects, const std::function<std::unique_ptr<FormatWriter>(const Objects&)>& make)
      : objects_(std::move(objects)) {
    Objects expanded;
    for (const FrameObject& object : objects_) {
      if (object.has_matter()) expanded.push_back(without_bodies(object));
      if (!object.bodies.empty()) expanded.push_back(surface_of(object));
    }
    format_ = make(expanded);
  }

  void add(const Frame& frame) override {
    check_bodies_of(frame);
    Frame expanded{.time = frame.time, .positions = {}, .velocities = {}, .number = frame.number};
    for (std::size_t o = 0; o < frame.positions.size(); ++o) {
      if (o >= objects_.size() || objects_[o].has_matter()) {
        expanded.positions.push_back(frame.positions[o]);
        if (!frame.velocities.empty()) expanded.velocities.push_back(frame.velocities[o]);
        if (!frame.triangles.empty()) expanded.triangles.push_back(frame.triangles[o]);
        if (!frame.lines.empty()) expanded.lines.push_back(frame.lines[o]);
      }
      if (o >= objects_.size() || objects_[o].bodies.empty()) continue;
      add_bodies(objects_[o], frame.bodies[o], !frame.velocities.empty(), expanded);
      if (!frame.triangles.empty()) expanded.triangles.emplace_back();
      if (!frame.lines.empty()) expanded.lines.emplace_back();
    }
    format_->add(expanded);
  }

  void finish() override { format_->finish(); }
  const std::vector<WrittenFile>& written() const override { return format_->written(); }

 private:
  static FrameObject without_bodies(const FrameObject& object) {
    FrameObject result = object;
    result.solids.clear(), result.bodies.clear();
    return result;
  }

  static FrameObject surface_of(const FrameObject& object) {
    FrameObject result{
        .name = object.name, .colour = object.colour, .width = object.width, .triangles = {}, .lines = {}};
    for (const FrameBody& body : object.bodies) {
      const TriangleMesh& solid = object.solids[body.solid];
      for (const auto& [a, b, c] : solid.triangles)
        result.triangles.push_back({result.particles + a, result.particles + b, result.particles + c});
      result.particles += static_cast<int>(solid.positions.size());
    }
    return result;
  }

  void check_bodies_of(const Frame& frame) const {
    // The format checks what it gets; only what the expansion itself reads is checked here.
    for (std::size_t o = 0; o < objects_.size(); ++o)
      if (!objects_[o].bodies.empty() &&
          (frame.bodies.size() <= o || frame.bodies[o].size() != objects_[o].bodies.size()))
        throw Error({"", 0, objects_[o].name, ""}, "a frame has another number of bodies than the scene");
  }

  static void add_bodies(const FrameObject& object, const std::vector<BodyMotion>& motions, bool with_velocities,
                         Frame& into) {
    std::vector<Vec3f> positions, velocities;
    for (std::size_t b = 0; b < motions.size(); ++b) {
      for (const Vec3f& p : object.solids[object.bodies[b].solid].positions) {
        const Vec3f arm = turned(motions[b].pose.rotation, p);
        positions.push_back(motions[b].pose.position + arm);
        if (with_velocities) velocities.push_back(vertex_velocity(motions[b], arm));
      }
    }
    into.positions.push_back(std::move(positions));
    if (with_velocities) into.velocities.push_back(std::move(velocities));
  }

  Objects objects_;
  std::unique_ptr<FormatWriter> format_;
};

}  // namespace

Vec3f turned(const Quatf& q, const Vec3f& v) {
  const Vec3f axis{q.x, q.y, q.z}, twice = 2.f * cross(axis, v);
  return v + q.w * twice + cross(axis, twice);
}

ShadedMesh shaded(const TriangleMesh& mesh) {
  constexpr float least_cosine = 0.8f;
  const auto unit = [](const Vec3f& v) {
    const float norm = std::sqrt(length_squared(v));
    return norm > 0 ? v * (1 / norm) : Vec3f{0, 1, 0};
  };
  std::vector<Vec3f> faces;  // normals times twice the area
  std::vector<std::vector<std::size_t>> around(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const int corner : {a, b, c}) around[corner].push_back(faces.size());
    faces.push_back(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
  }
  ShadedMesh result;
  std::map<std::array<float, 4>, int> known;  // vertex and normal
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int corner = mesh.triangles[t][k];
      Vec3f sum{};
      for (const std::size_t other : around[corner])
        if (dot(unit(faces[other]), unit(faces[t])) > least_cosine) sum += faces[other];
      const Vec3f normal = unit(sum);
      const auto [found, is_new] = known.try_emplace({static_cast<float>(corner), normal.x, normal.y, normal.z},
                                                     static_cast<int>(result.positions.size()));
      if (is_new) result.positions.push_back(mesh.positions[corner]), result.normals.push_back(normal);
      triangle[k] = found->second;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

void describe_bodies(const Object& object, FrameObject& result) {
  std::map<std::string, int> known;
  for (const ObjectBody& body : object.bodies) {
    const auto [found, is_new] =
        known.try_emplace(SolidKey(body.solids).text(), static_cast<int>(result.solids.size()));
    if (is_new) result.solids.push_back(mesh_of(body.solids, segments_for(object.bodies.size())));
    result.bodies.push_back({body.name, found->second});
  }
}

std::vector<bool> body_centres(const Object& object) {
  std::vector<bool> result(object.positions.size(), false);
  for (const ObjectBody& body : object.bodies) result.at(static_cast<std::size_t>(body.particle)) = true;
  return result;
}

std::vector<BodyMotion> body_motions(const Object& object, const ObjectView& view) {
  if (object.bodies.empty()) return {};
  const std::vector<Vec3f> positions = view.positions(), velocities = view.velocities(),
                           angular_velocities = view.angular_velocities();
  const std::vector<Quatf> orientations = view.orientations();
  std::vector<BodyMotion> result;
  for (const ObjectBody& body : object.bodies) {
    const auto particle = static_cast<std::size_t>(body.particle), frame = static_cast<std::size_t>(body.frame);
    result.push_back(
        {{positions.at(particle), orientations.at(frame)}, velocities.at(particle), angular_velocities.at(frame)});
  }
  return result;
}

std::unique_ptr<FormatWriter> make_surface_writer(
    const Objects& objects, const std::function<std::unique_ptr<FormatWriter>(const Objects&)>& make) {
  for (const FrameObject& object : objects)
    if (!object.bodies.empty()) return std::make_unique<SurfaceWriter>(objects, make);
  return make(objects);
}

}  // namespace pliant::output
