#include "urdf_known.h"

#ifdef PLIANT_XML

#include <tinyxml2.h>

#include <algorithm>
#include <map>

#include "scene_hints.h"
#include "text_lines.h"

namespace pliant::urdf {

namespace {

using Names = std::vector<std::string>;

/// What an element of URDF may contain: what is read, and what is known but ignored.
struct Known {
  Names children, attributes, ignored_children, ignored_attributes;
};

const std::map<std::string, Known>& known_elements() {
  static const std::map<std::string, Known> known{
      {"robot", {{"link", "joint", "material"}, {"name", "version"}, {"transmission", "gazebo", "sensor"}, {}}},
      {"link", {{"inertial", "visual", "collision"}, {"name"}, {"sensor"}, {"type"}}},
      {"inertial", {{"origin", "mass", "inertia"}, {}, {}, {}}},
      {"visual", {{"origin", "geometry", "material"}, {"name"}, {}, {}}},
      {"collision", {{"origin", "geometry", "material"}, {"name"}, {}, {}}},
      {"geometry", {{"box", "sphere", "cylinder", "capsule", "mesh"}, {}, {}, {}}},
      {"origin", {{}, {"xyz", "rpy"}, {}, {}}},
      {"mass", {{}, {"value"}, {}, {}}},
      {"inertia", {{}, {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"}, {}, {}}},
      {"box", {{}, {"size"}, {}, {}}},
      {"sphere", {{}, {"radius"}, {}, {}}},
      {"cylinder", {{}, {"radius", "length"}, {}, {}}},
      {"capsule", {{}, {"radius", "length"}, {}, {}}},
      {"mesh", {{}, {"filename", "scale"}, {}, {}}},
      {"material", {{"color"}, {"name"}, {"texture"}, {}}},
      {"color", {{}, {"rgba"}, {}, {}}},
      {"joint",
       {{"parent", "child", "origin", "axis", "limit", "dynamics", "mimic"},
        {"name", "type"},
        {"calibration", "safety_controller"},
        {}}},
      {"parent", {{}, {"link"}, {}, {}}},
      {"child", {{}, {"link"}, {}, {}}},
      {"axis", {{}, {"xyz"}, {}, {}}},
      {"limit", {{}, {"lower", "upper", "effort", "velocity"}, {}, {}}},
      {"dynamics", {{}, {"friction", "damping"}, {}, {}}},
      {"mimic", {{}, {"joint", "multiplier", "offset"}, {}, {}}}};
  return known;
}

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class Walk {
 public:
  explicit Walk(const std::string& path) : path_(path) {}

  void element(const tinyxml2::XMLElement& at) {
    const auto entry = known_elements().find(at.Name());
    if (entry == known_elements().end()) return;
    const Known& known = entry->second;
    for (const tinyxml2::XMLAttribute* one = at.FirstAttribute(); one != nullptr; one = one->Next()) {
      const std::string name = one->Name();
      const bool is_of_xml = name.rfind("xml", 0) == 0;  // such as xmlns:xacro
      if (!is_of_xml && !has(known.attributes, name))
        ignored("attribute ", name, at.Name(), one->GetLineNum(), known.attributes,
                has(known.ignored_attributes, name));
    }
    for (const tinyxml2::XMLElement* one = at.FirstChildElement(); one != nullptr; one = one->NextSiblingElement()) {
      if (has(known.children, one->Name()))
        element(*one);
      else
        ignored("", one->Name(), at.Name(), one->GetLineNum(), known.children,
                has(known.ignored_children, one->Name()));
    }
  }

  void add_to(std::vector<std::string>& warnings) const {
    for (const Kind& kind : kinds_) {
      const int more = kind.count - 1;
      warnings.push_back(kind.text + (more == 0 ? "" : " (and " + std::to_string(more) + " more)"));
    }
  }

 private:
  struct Kind {
    std::string key, text;
    int count = 0;
  };

  void ignored(const std::string& what, const std::string& name, const std::string& inside, int line,
               const Names& known, bool is_known) {
    const std::string key = what + in_quotes(name) + " of " + inside;
    const auto found = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& kind) { return kind.key == key; });
    if (found != kinds_.end()) {
      ++found->count;
      return;
    }
    const std::string near = is_known ? "" : scene_file::nearest_name(name, known);
    const std::string problem = is_known       ? " is not supported and ignored"
                                : near.empty() ? " is unknown and ignored"
                                               : " is unknown and ignored; did you mean '" + near + "'?";
    kinds_.push_back({key, path_ + ":" + std::to_string(line) + ": " + key + problem, 1});
  }

  const std::string& path_;
  std::vector<Kind> kinds_;
};

}  // namespace

void name_ignored(const tinyxml2::XMLElement& robot, const std::string& path, std::vector<std::string>& warnings) {
  Walk walk(path);
  walk.element(robot);
  walk.add_to(warnings);
}

}  // namespace pliant::urdf

#endif
