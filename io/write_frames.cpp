// Converts a scene to what the writers see, and makes the checks that they share.
#include "write_frames.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "pliant/error.h"
#include "write_bodies.h"

namespace pliant::output {

namespace {

/// Follows edges to form polylines. Each edge is used once.
class LineWalk {
 public:
  explicit LineWalk(const std::vector<std::array<int, 2>>& edges) : edges_(edges), used_(edges.size(), false) {
    int particles = 0;
    for (const auto& edge : edges) particles = std::max({particles, edge[0] + 1, edge[1] + 1});
    at_.resize(static_cast<std::size_t>(particles));
    next_.resize(at_.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      at_[edges[e][0]].push_back(e);
      if (edges[e][1] != edges[e][0]) at_[edges[e][1]].push_back(e);
    }
  }

  std::vector<std::vector<int>> lines() {
    std::vector<std::vector<int>> result;
    // Starts from ends and branches first, so that afterwards only closed loops remain.
    for (const bool loops : {false, true}) {
      for (int particle = 0; particle < static_cast<int>(at_.size()); ++particle) {
        if (!loops && at_[particle].size() == 2) continue;
        for (std::vector<int> line = walk(particle); line.size() > 1; line = walk(particle))
          result.push_back(std::move(line));
      }
    }
    return result;
  }

 private:
  std::vector<int> walk(int particle) {
    std::vector<int> line{particle};
    for (bool more = true; more;) {
      // Where to resume the search at this particle: a hub with 1e5 edges is visited as often.
      std::size_t& next = next_[particle];
      while (next < at_[particle].size() && used_[at_[particle][next]]) ++next;
      if (next == at_[particle].size()) break;
      const std::size_t e = at_[particle][next];
      used_[e] = true;
      particle = edges_[e][0] == particle ? edges_[e][1] : edges_[e][0];
      line.push_back(particle);
      more = at_[particle].size() == 2;
    }
    return line;
  }

  const std::vector<std::array<int, 2>>& edges_;
  std::vector<bool> used_;
  std::vector<std::vector<std::size_t>> at_;
  std::vector<std::size_t> next_;  // for each particle, how many of its edges are known to be used
};

bool finite(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[noreturn]] void refuse(const std::string& path, const std::string& object, const std::string& element,
                         const std::string& problem) {
  throw Error({.file = path, .line = 0, .object = object, .element = element}, problem);
}

void check_bodies(const std::string& path, const FrameObject& object, const std::vector<BodyMotion>& motions) {
  if (motions.size() != object.bodies.size())
    refuse(path, object.name, {}, "a frame has another number of bodies than the scene");
  for (std::size_t b = 0; b < motions.size(); ++b) {
    const RigidPose& pose = motions[b].pose;
    const Quatf& q = pose.rotation;
    if (!finite(pose.position) || !finite({q.x, q.y, q.z}) || !std::isfinite(q.w))
      refuse(path, object.name, "body '" + object.bodies[b].name + "'", "has a pose that is not finite");
  }
}

/// Throws an Error unless a frame has the lines of an object that is relinked.
void check_lines(const std::string& path, const std::vector<FrameObject>& objects, const Frame& frame, std::size_t o) {
  if (!objects[o].is_relinked) return;
  if (frame.lines.size() != objects.size()) refuse(path, objects[o].name, {}, "a frame lacks the links that are left");
  for (const std::vector<int>& line : frame.lines[o])
    for (const int i : line)
      if (i < 0 || i >= objects[o].particles)
        refuse(path, objects[o].name, {}, "a link uses a particle that does not exist");
}

std::string identifier(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    result += plain ? c : '_';
  }
  if (result.empty()) result = "object";
  if (result[0] >= '0' && result[0] <= '9') result.insert(result.begin(), '_');
  return result.substr(0, 100);
}

}  // namespace

void FormatWriter::commit(OutputFile& file) {
  file.commit();
  written_.push_back({file.path(), file.size()});
}

std::vector<std::vector<int>> join_lines(const std::vector<std::array<int, 2>>& edges) {
  return LineWalk(edges).lines();
}

FrameObject describe(const Object& object) {
  FrameObject result{.name = object.name,
                     .colour = object.colour,
                     .width = 2 * object.thickness,
                     .particles = static_cast<int>(object.positions.size()),
                     .triangles = object.triangles,
                     .lines = {}};
  if (object.skin) {
    result.particles = static_cast<int>(object.skin->vertices.size());
    result.triangles = object.skin->triangles;
  }
  describe_bodies(object, result);
  if (const int group = line_group_of(object); result.triangles.empty() && group >= 0)
    result.lines = lines_of(object, group);
  return result;
}

int line_group_of(const Object& object) {
  const auto is_it = [](const ConstraintGroup& group) {
    return group.type == "distance" && group.particles.size() >= 2;
  };
  const auto found = std::find_if(object.constraints.begin(), object.constraints.end(), is_it);
  return found == object.constraints.end() ? -1 : static_cast<int>(found - object.constraints.begin());
}

std::vector<std::vector<int>> lines_of(const Object& object, int group) {
  const std::vector<int>& particles = object.constraints.at(static_cast<std::size_t>(group)).particles;
  const std::vector<bool> is_body = body_centres(object);
  std::vector<std::array<int, 2>> edges;
  for (std::size_t i = 0; i + 1 < particles.size(); i += 2) {
    const std::array<int, 2> edge{particles[i], particles[i + 1]};
    if (object.bodies.empty() || !is_body.at(edge[0]) || !is_body.at(edge[1])) edges.push_back(edge);
  }
  return join_lines(edges);
}

std::vector<FrameObject> describe(const Scene& scene) {
  std::vector<FrameObject> result;
  for (const Object& object : scene.objects) result.push_back(describe(object));
  return result;
}

bool is_any_remeshed(const std::vector<FrameObject>& objects) {
  return std::any_of(objects.begin(), objects.end(), [](const FrameObject& object) { return object.is_remeshed; });
}

bool is_any_varying(const std::vector<FrameObject>& objects) {
  return std::any_of(objects.begin(), objects.end(), [](const FrameObject& object) {
    return object.is_remeshed || object.is_relinked || object.varies;
  });
}

std::vector<FrameObject> present_objects(const std::vector<FrameObject>& objects, const Frame& frame) {
  std::vector<FrameObject> result = objects;
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (result[i].is_relinked) result[i].lines = frame.lines[i];
    if (!result[i].is_remeshed && !result[i].varies) continue;
    result[i].particles = static_cast<int>(frame.positions[i].size());
    if (result[i].is_remeshed) result[i].triangles = frame.triangles[i];
  }
  return result;
}

void check_frame(const std::string& path, const std::vector<FrameObject>& objects, const Frame& frame,
                 double last_time) {
  if (!(frame.time > last_time)) refuse(path, {}, {}, "the time of a frame is not after that of the previous one");
  if (frame.positions.size() != objects.size())
    refuse(path, {}, {}, "a frame has another number of objects than the scene");
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const std::vector<Vec3f>& positions = frame.positions[i];
    const bool is_mesh = objects[i].is_remeshed;
    const bool fits = is_mesh ? frame.triangles.size() == objects.size()
                              : (objects[i].varies || static_cast<int>(positions.size()) == objects[i].particles) &&
                                    (frame.velocities.empty() || frame.velocities[i].size() == positions.size());
    if (!fits) refuse(path, objects[i].name, {}, "a frame has another number of particles than the scene");
    check_lines(path, objects, frame, i);
    const auto bad = std::find_if_not(positions.begin(), positions.end(), finite);
    if (bad != positions.end())
      refuse(path, objects[i].name, "particle " + std::to_string(bad - positions.begin()),
             "has a position that is not finite");
    check_bodies(path, objects[i], frame.bodies.empty() ? std::vector<BodyMotion>{} : frame.bodies.at(i));
  }
}

std::vector<std::string> identifiers(const std::vector<FrameObject>& objects) {
  std::vector<std::string> names;
  names.reserve(objects.size());
  for (const FrameObject& object : objects) names.push_back(object.name);
  return identifiers(names);
}

std::vector<std::string> identifiers(const std::vector<std::string>& names) {
  std::vector<std::string> result;
  std::set<std::string> taken;
  for (const std::string& given : names) {
    const std::string base = identifier(given);
    std::string name = base;
    for (int number = 2; !taken.insert(name).second; ++number) name = base + "_" + std::to_string(number);
    result.push_back(name);
  }
  return result;
}

std::vector<Vec3f> vertex_normals(const std::vector<Vec3f>& positions,
                                  const std::vector<std::array<int, 3>>& triangles) {
  std::vector<Vec3d> sums(positions.size());
  const auto wide = [&](int i) { return Vec3d{positions[i].x, positions[i].y, positions[i].z}; };
  for (const auto& [a, b, c] : triangles) {
    const Vec3d normal = cross(wide(b) - wide(a), wide(c) - wide(a));
    for (const int i : {a, b, c}) sums[i] += normal;
  }
  std::vector<Vec3f> result(positions.size(), Vec3f{0, 1, 0});
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double length = std::sqrt(length_squared(sums[i]));
    if (!(length > 1e-30)) continue;
    const Vec3d unit = sums[i] * (1 / length);
    result[i] = {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
  }
  return result;
}

SplitPath split_path(const std::string& path) {
  const std::size_t name = path.rfind('/') + 1;  // npos + 1 is 0
  const std::size_t point = path.rfind('.');
  if (point == std::string::npos || point <= name) return {path, ""};
  std::string suffix = path.substr(point);
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return {path.substr(0, point), suffix};
}

std::string file_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

std::string frame_number(std::int64_t frame) {
  const std::string digits = std::to_string(frame);
  return digits.size() < 4 ? std::string(4 - digits.size(), '0') + digits : digits;
}

std::unique_ptr<FormatWriter> make_format_writer(const std::string& path, const Objects& objects, double frame_time,
                                                 const FileSink& sink) {
  const Destination to{path, sink ? std::make_shared<const FileSink>(sink) : nullptr};
  const SplitPath parts = split_path(path);
  const std::string& suffix = parts.suffix;
  const auto remeshed =
      std::find_if(objects.begin(), objects.end(), [](const FrameObject& one) { return one.is_remeshed; });
  if (remeshed != objects.end() && (suffix == ".glb" || suffix == ".pc2"))
    throw Error({.file = path, .line = 0, .object = remeshed->name, .element = {}},
                "is the surface of a liquid, or tears: another mesh in each frame, which '" + suffix + "' cannot have",
                "write .obj, .ply, .usda or .pvd");
  const auto glb = [&](const Objects& all) { return make_glb_writer(to, all); };
  if (suffix == ".glb") return make_segment_writer(objects, glb);
  if (suffix == ".usda") return make_usda_writer(to, objects, frame_time);
  const auto surfaces = [&](auto make) { return make_surface_writer(objects, make); };
  if (suffix == ".obj") return surfaces([&](const Objects& all) { return make_obj_sequence(to, all); });
  if (suffix == ".ply") return surfaces([&](const Objects& all) { return make_ply_sequence(to, all); });
  const auto pc2 = [&](const Objects& all) { return make_pc2_writer(to, all, frame_time); };
  if (suffix == ".pc2")
    return make_segment_writer(objects, [&](const Objects& segments) { return make_surface_writer(segments, pc2); });
  if (suffix == ".pvd") return surfaces([&](const Objects& all) { return make_pvd_writer(to, all); });
  throw Error({.file = path, .line = 0, .object = {}, .element = {}}, "'" + suffix + "' is not a geometry format",
              "end it in .obj, .ply, .glb, .usda, .pc2 or .pvd");
}

}  // namespace pliant::output
