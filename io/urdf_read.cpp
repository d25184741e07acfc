// Reads URDF by tinyxml2.
#include <algorithm>

#include "file_bytes.h"
#include "pliant/error.h"
#include "pliant/motion.h"
#include "text_lines.h"
#include "urdf_known.h"
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

  void warn(int line, const std::string& text) {
    warnings_.push_back(path_ + ":" + std::to_string(line) + ": " + text);
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
      fail(at.GetLineNum(), std::string(at.Name()) + ", " + name + ": " + in_quotes(word) + " " + describe(problem),
           word.find(',') == std::string_view::npos ? "give finite numbers"
                                                    : "separate numbers by blanks, with decimal points");
    return value;
  }

  /// The numbers of an attribute, which are at least `least` and at most `most`.
  std::vector<float> numbers(const Element& at, const char* name, std::size_t least, std::size_t most) const {
    const std::string all = text(at, name);
    std::string_view rest = all;
    std::vector<float> values;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest))
      values.push_back(number(at, name, word));
    if (values.size() < least || values.size() > most)
      fail(at.GetLineNum(),
           std::string(at.Name()) + ", " + name + ": needs " + std::to_string(most) + " numbers, has " +
               std::to_string(values.size()),
           "give " + std::to_string(most) + " numbers, separated by blanks");
    return values;
  }

  float number(const Element& at, const char* name) const { return number(at, name, text(at, name)); }
  float number(const Element& at, const char* name, float fallback) const {
    return at.Attribute(name) == nullptr ? fallback : number(at, name);
  }

  Vec3f vector(const Element& at, const char* name) const {
    const std::vector<float> values = numbers(at, name, 3, 3);
    return {values[0], values[1], values[2]};
  }
  Vec3f vector(const Element& at, const char* name, const Vec3f& fallback) const {
    return at.Attribute(name) == nullptr ? fallback : vector(at, name);
  }

  /// A number that is not negative.
  float magnitude(const Element& at, const char* name, float fallback) const {
    const float value = number(at, name, fallback);
    if (value < 0)
      fail(at.GetLineNum(), std::string(at.Name()) + " has a negative " + name + ": " + at.Attribute(name),
           "give a number of at least 0");
    return value;
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
};

std::optional<Geometry> geometry_of(Reader& reader, const Element& parent) {
  const Element* at = parent.FirstChildElement("geometry");
  const Element* shape = at == nullptr ? nullptr : at->FirstChildElement();
  if (shape == nullptr)
    reader.fail(parent.GetLineNum(), std::string(parent.Name()) + " has no geometry", "add a shape");
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
    return {};  // name_ignored() names it
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
  if (inertial.mass < 0)
    reader.fail(mass->GetLineNum(), std::string("inertial has a negative mass: ") + mass->Attribute("value") + " kg",
                "give a mass above 0, or leave the inertial out to get that of the shapes");
  inertial.moments = {reader.number(*inertia, "ixx"), reader.number(*inertia, "iyy"), reader.number(*inertia, "izz")};
  inertial.products = {reader.number(*inertia, "iyz", 0), reader.number(*inertia, "ixz", 0),
                       reader.number(*inertia, "ixy", 0)};
  return inertial;
}

/// The colour of a material: its own, or that of the robot's material of this name.
std::optional<Vec3f> colour_of(const Reader& reader, const Element& robot, const Element& material) {
  if (const Element* colour = material.FirstChildElement("color")) {
    const std::vector<float> rgba = reader.numbers(*colour, "rgba", 3, 4);
    return Vec3f{rgba[0], rgba[1], rgba[2]};
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
      if (child->Attribute("effort") != nullptr) joint.effort = reader.magnitude(*child, "effort", 0);
      joint.velocity = reader.number(*child, "velocity", 0);
    } else if (kind == "dynamics") {
      joint.friction = reader.magnitude(*child, "friction", 0);
      joint.damping = reader.magnitude(*child, "damping", 0);
    } else if (kind == "mimic") {
      joint.mimics = reader.text(*child, "joint");
      joint.multiplier = reader.number(*child, "multiplier", 1);
      joint.offset = reader.number(*child, "offset", 0);
    }
  }
  return joint;
}

const char* xml_error_in_words(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "it has no element";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "this element is closed by a tag of another name";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute of this element is not of the form name=\"value\"";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment that begins here has no end";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested too deeply";
    case tinyxml2::XML_ERROR_PARSING:
      return "an element that begins here has no end";
    default:
      return "a tag is damaged";
  }
}

/// Throws an Error with the line at which tinyxml2 stopped, and its words.
[[noreturn]] void refuse_xml(const Reader& reader, const tinyxml2::XMLDocument& document, std::string_view bytes) {
  const int line = document.ErrorLineNum();
  LineReader lines(bytes);
  while (lines.number() < line && lines.next()) continue;
  std::string_view text = lines.line();
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t")));
  reader.fail(line,
              std::string("is not valid XML: ") + xml_error_in_words(document.ErrorID()) +
                  (text.empty() ? "" : ": " + in_quotes(text)),
              "correct the file");
}

}  // namespace

Robot parse(std::string_view bytes, const std::string& name, std::vector<std::string>& warnings) {
  Reader reader(name, warnings);
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS) refuse_xml(reader, document, bytes);
  const Element* root = document.FirstChildElement("robot");
  if (root == nullptr) reader.fail(1, "has no element 'robot'", "give a URDF file; xacro files are expanded first");
  Robot robot;
  robot.name = reader.text(*root, "name");
  name_ignored(*root, name, warnings);
  for (const Element* child = root->FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const std::string kind = child->Name();
    if (kind == "link")
      robot.links.push_back(link_of(reader, *root, *child));
    else if (kind == "joint")
      robot.joints.push_back(joint_of(reader, *child));
  }
  return robot;
}

#else

Robot parse(std::string_view, const std::string& name, std::vector<std::string>&) {
  throw Error({.file = name, .line = 0, .object = {}, .element = {}}, "cannot be read: this build has no XML reader",
              "install Debian's libtinyxml2-dev and build again");
}

#endif

Robot read(const std::string& path, std::vector<std::string>& warnings) {
  constexpr std::uint64_t largest = std::uint64_t{16} << 20;
  return parse(read_file_bytes(path, largest), path, warnings);
}

}  // namespace pliant::urdf
