#include "write_usda_bodies.h"

#include <algorithm>
#include <utility>

#include "usda_text.h"

namespace pliant::output {

namespace {

void quaternion(std::string& text, const Quatf& q) {
  append(text += '(', q.w);
  append(text += ", ", Vec3f{q.x, q.y, q.z}, ", ");
  text += ')';
}

Quatf negated(const Quatf& q) { return {-q.x, -q.y, -q.z, -q.w}; }

/// One value if all are equal, else time samples.
template <class Value, class Write>
std::string samples(const std::string& attribute, const std::vector<std::string>& times,
                    const std::vector<RigidPose>& poses, Value value, Write write) {
  std::string text = "            " + attribute;
  const auto is_first = [&](const RigidPose& pose) { return value(pose) == value(poses.front()); };
  if (std::all_of(poses.begin(), poses.end(), is_first)) {
    write(text += " = ", value(poses.front()));
    return text + "\n";
  }
  text += ".timeSamples = {\n";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    write(text += "                " + times[i] + ": ", value(poses[i]));
    text += ",\n";
  }
  return text + "            }\n";
}

}  // namespace

void UsdaBodies::add(const std::string& time, const std::vector<BodyMotion>& frame) {
  times_.push_back(time);
  for (std::size_t b = 0; b < poses_.size(); ++b) {
    RigidPose pose = frame[b].pose;
    // q and -q are one rotation; between samples of one sign, tools interpolate along the shorter arc.
    if (!poses_[b].empty()) {
      const Quatf &q = pose.rotation, &before = poses_[b].back().rotation;
      if (q.x * before.x + q.y * before.y + q.z * before.z + q.w * before.w < 0) pose.rotation = negated(q);
    }
    poses_[b].push_back(pose);
  }
}

void UsdaBodies::write_solid(OutputFile& file, const std::string& name, const ShadedMesh& mesh) const {
  const auto number = [](std::string& text, int i) { append(text, i); };
  std::vector<int> indices;
  for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  std::string colour;
  tuple(colour, object_.colour);
  file.write("\n        class Mesh \"" + name + "\"\n        {\n");
  file.write("            uniform bool doubleSided = 1\n            uniform token subdivisionScheme = \"none\"\n");
  file.write("            int[] faceVertexCounts = " + listed(std::vector<int>(mesh.triangles.size(), 3), number) +
             "\n");
  file.write("            int[] faceVertexIndices = " + listed(indices, number) + "\n");
  file.write("            color3f[] primvars:displayColor = [" + colour + "]\n");
  file.write("            float3[] extent = " + extent(mesh.positions, 0) + "\n");
  file.write("            point3f[] points = " + listed(mesh.positions, tuple) + "\n");
  file.write("            normal3f[] normals = " + listed(mesh.normals, tuple) +
             " (\n                interpolation = \"vertex\"\n            )\n        }\n");
}

void UsdaBodies::write_body(OutputFile& file, std::size_t body, const std::string& name,
                            const std::string& solid) const {
  file.write("\n        def Mesh \"" + name + "\" (\n            doc = " + usda_string(object_.bodies[body].name) +
             "\n            inherits = <" + solid + ">\n        )\n        {\n");
  const auto place = [](const RigidPose& pose) { return pose.position; };
  const auto rotation = [](const RigidPose& pose) { return pose.rotation; };
  file.write(samples("double3 xformOp:translate", times_, poses_[body], place, tuple));
  file.write(samples("quatf xformOp:orient", times_, poses_[body], rotation, quaternion));
  file.write("            uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n        }\n");
}

void UsdaBodies::write(OutputFile& file, const std::string& name) const {
  std::vector<std::string> names(object_.solids.size(), "solid");
  for (const FrameBody& body : object_.bodies) names.push_back(body.name);
  names = identifiers(names);
  file.write("\n    def Xform \"" + name + "\" (\n        doc = " + usda_string(object_.name) + "\n    )\n    {");
  for (std::size_t s = 0; s < object_.solids.size(); ++s) write_solid(file, names[s], shaded(object_.solids[s]));
  for (std::size_t b = 0; b < object_.bodies.size(); ++b)
    write_body(file, b, names[object_.solids.size() + b],
               "/World/" + name + "/" + names[static_cast<std::size_t>(object_.bodies[b].solid)]);
  file.write("    }\n");
}

}  // namespace pliant::output
