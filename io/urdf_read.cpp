// Reads URDF by tinyxml2.
#include <set>

#include "file_bytes.h"
#include "pliant/error.h"
#include "pliant/motion.h"
#include "text_lines.h"
#include "urdf_model.h"

#ifdef PLIANT_XML
#include <tinyxml2.h>
#endif

namespace pliant::urdf {

#ifdef PLIANT_XML

namespace {

using Element = tinyxml2::XMLElement;

Quatf product(const Quatf& a, const Quatf& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/// The file that is read, for errors and warnings.
class Reader {
 public:
  Reader(const std::string& path, std::vector<std::string>& warnings) : path_(path), warnings_(warnings) {}

  [[noreturn]] void fail(int line, const std::string& problem, const std::string& advice) const {
    throw Error({.file = path_, .line = line, .object = {}, .element = {}}, problem, advice);
  }

  /// Names an ignored element, each kind once.
  void ignore(const Element& at, const std::string& inside) {
    const std::string what = quoted(at.Name()) + " of " + inside;
    if (ignored_.insert(what).second)
      warnings_.push_back(path_ + ":" + std::to_string(at.GetLineNum()) + ": " + what + " is not supported and ignored");
  }

  std::string text(const Element& at, const char* name) const {
    const char* value = at.Attribute(name);
    if (value == nullptr || *value == '\0')
      fail(at.GetLineNum(), std::string(at.Name()) + " has no attribute '" + name + "'", "add it");
    return value;
  }

  float number(const Element& at, const char* name, std::string_view word) const {
    float value = 0;
    const NumberProblem problem = parse_float(word, value);
    if (problem != NumberProblem::none)
      fail(at.GetLineNum(), std::string(at.Name()) + ", " + name + ": " + quoted(word) + " " + describe(problem),
           "give finite numbers");
    return value;
  }

  float number(const Element& at, const char* name) const { return number(at, name, text(at, name)); }
  float number(const Element& at, const char* name, float fallback) const {
    return at.Attribute(name) == nullptr ? fallback : number(at, name);
  }

  Vec3f vector(const Element& at, const char* name) const {
    const std::string all = text(at, name);
    std::string_view rest = all;
    std::array<float, 3> values{};
    for (float& value : values) value = number(at, name, take_word(rest));
    if (!take_word(rest).empty()) fail(at.GetLineNum(), std::string(name) + " has more than three numbers", "give three");
    return {values[0], values[1], values[2]};
  }
  Vec3f vector(const Element& at, const char* name, const Vec3f& fallback) const {
    return at.Attribute(name) == nullptr ? fallback : vector(at, name);
  }

  float positive(const Element& at, const char* name) const {
    const float value = number(at, name);
    if (!(value > 0))
      fail(at.GetLineNum(), std::string(at.Name()) + " has a " + name + " that is not positive", "give metres or kg");
    return value;
  }

  /// The pose in the child `origin`: roll, pitch and yaw are rotations about the fixed x, y and z axes, in this order.
  Pose origin(const Element& parent) const {
    const Element* at = parent.FirstChildElement("origin");
    if (at == nullptr) return {};
    constexpr float degree = 57.29577951308232f;
    const Vec3f rpy = vector(*at, "rpy", {});
    const Quatf roll = rotation({1, 0, 0}, rpy.x * degree), pitch = rotation({0, 1, 0}, rpy.y * degree),
                yaw = rotation({0, 0, 1}, rpy.z * degree);
    return {vector(*at, "xyz", {}), product(yaw, product(pitch, roll))};
  }

 private:
  const std::string& path_;
  std::vector<std::string>& warnings_;
  std::set<std::string> ignored_;
};

std::optional<Geometry> geometry_of(Reader& reader, const Element& parent) {
  const Element* at = parent.FirstChildElement("geometry");
  const Element* shape = at == nullptr ? nullptr : at->FirstChildElement();
  if (shape == nullptr) reader.fail(parent.GetLineNum(), std::string(parent.Name()) + " has no geometry", "add a shape");
  Geometry geometry;
  geometry.origin = reader.origin(parent);
  geometry.line = shape->GetLineNum();
  const std::string kind = shape->Name();
  if (kind == "box") {
    geometry.size = reader.vector(*shape, "size");
  } else if (kind == "sphere") {
    geometry.kind = Geometry::Kind::sphere;
    geometry.size.x = reader.positive(*shape, "radius");
  } else if (kind == "cylinder" || kind == "capsule") {
    geometry.kind = kind == "cylinder" ? Geometry::Kind::cylinder : Geometry::Kind::capsule;
    geometry.size = {reader.positive(*shape, "radius"), reader.positive(*shape, "length"), 0};
  } else if (kind == "mesh") {
    geometry.kind = Geometry::Kind::mesh;
    geometry.file = reader.text(*shape, "filename");
    geometry.scale = reader.vector(*shape, "scale", {1, 1, 1});
  } else {
    reader.ignore(*shape, "geometry");
    return {};
  }
  return geometry;
}

Inertial inertial_of(Reader& reader, const Element& at) {
  Inertial inertial;
  inertial.line = at.GetLineNum();
  inertial.origin = reader.origin(at);
  const Element *mass = at.FirstChildElement("mass"), *inertia = at.FirstChildElement("inertia");
  if (mass == nullptr || inertia == nullptr) reader.fail(at.GetLineNum(), "inertial lacks mass or inertia", "add both");
  inertial.mass = reader.number(*mass, "value");
  inertial.moments = {reader.number(*inertia, "ixx"), reader.number(*inertia, "iyy"), reader.number(*inertia, "izz")};
  inertial.products = {reader.number(*inertia, "iyz", 0), reader.number(*inertia, "ixz", 0),
                       reader.number(*inertia, "ixy", 0)};
  return inertial;
}

/// The colour of a material: its own, or that of the robot's material of this name.
std::optional<Vec3f> colour_of(const Reader& reader, const Element& robot, const Element& material) {
  if (const Element* colour = material.FirstChildElement("color")) {
    const std::string all = reader.text(*colour, "rgba");
    std::string_view rest = all;
    Vec3f rgb;
    for (float* part : {&rgb.x, &rgb.y, &rgb.z}) *part = reader.number(*colour, "rgba", take_word(rest));
    return rgb;
  }
  const char* name = material.Attribute("name");
  for (const Element* at = robot.FirstChildElement("material"); at != nullptr && name != nullptr;
       at = at->NextSiblingElement("material"))
    if (at != &material && std::string(name) == (at->Attribute("name") != nullptr ? at->Attribute("name") : "") &&
        at->FirstChildElement("color") != nullptr)
      return colour_of(reader, robot, *at);
  return {};
}

Link link_of(Reader& reader, const Element& robot, const Element& at) {
  Link link;
  link.name = reader.text(at, "name");
  link.line = at.GetLineNum();
  for (const Element* child = at.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const std::string kind = child->Name();
    if (kind == "inertial") {
      link.inertial = inertial_of(reader, *child);
    } else if (kind == "visual" || kind == "collision") {
      const std::optional<Geometry> geometry = geometry_of(reader, *child);
      if (geometry) (kind == "visual" ? link.visual : link.collision).push_back(*geometry);
      const Element* material = child->FirstChildElement("material");
      if (material != nullptr && !link.colour) link.colour = colour_of(reader, robot, *material);
    } else {
      reader.ignore(*child, "link");
    }
  }
  return link;
}

std::string named_link(const Reader& reader, const Element& joint, const char* which) {
  const Element* at = joint.FirstChildElement(which);
  if (at == nullptr) reader.fail(joint.GetLineNum(), std::string("joint has no ") + which, "name the link");
  return reader.text(*at, "link");
}

Joint joint_of(Reader& reader, const Element& at) {
  Joint joint;
  joint.name = reader.text(at, "name");
  joint.type = reader.text(at, "type");
  joint.line = at.GetLineNum();
  joint.parent = named_link(reader, at, "parent");
  joint.child = named_link(reader, at, "child");
  joint.origin = reader.origin(at);
  for (const Element* child = at.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const std::string kind = child->Name();
    if (kind == "axis") {
      joint.axis = reader.vector(*child, "xyz");
    } else if (kind == "limit") {
      joint.has_limit = child->Attribute("lower") != nullptr || child->Attribute("upper") != nullptr;
      joint.lower = reader.number(*child, "lower", 0);
      joint.upper = reader.number(*child, "upper", 0);
      joint.effort = reader.number(*child, "effort", 0);
      joint.velocity = reader.number(*child, "velocity", 0);
    } else if (kind == "dynamics") {
      joint.friction = reader.number(*child, "friction", 0);
      if (reader.number(*child, "damping", 0) != 0) reader.ignore(*child, "joint (its damping)");
    } else if (kind != "parent" && kind != "child" && kind != "origin") {
      reader.ignore(*child, "joint");
    }
  }
  return joint;
}

}  // namespace

Robot read(const std::string& path, std::vector<std::string>& warnings) {
  constexpr std::uint64_t largest = std::uint64_t{16} << 20;
  const std::string bytes = read_file_bytes(path, largest);
  Reader reader(path, warnings);
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS)
    reader.fail(document.ErrorLineNum(), std::string("is not valid XML: ") + document.ErrorName(), "correct the file");
  const Element* root = document.FirstChildElement("robot");
  if (root == nullptr) reader.fail(1, "has no element 'robot'", "give a URDF file; xacro files are expanded first");
  Robot robot;
  robot.name = reader.text(*root, "name");
  for (const Element* child = root->FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const std::string kind = child->Name();
    if (kind == "link")
      robot.links.push_back(link_of(reader, *root, *child));
    else if (kind == "joint")
      robot.joints.push_back(joint_of(reader, *child));
    else if (kind != "material")
      reader.ignore(*child, "robot");
  }
  return robot;
}

#else

Robot read(const std::string& path, std::vector<std::string>&) {
  throw Error({.file = path, .line = 0, .object = {}, .element = {}}, "cannot be read: this build has no XML reader",
              "install Debian's libtinyxml2-dev and build again");
}

#endif

}  // namespace pliant::urdf
