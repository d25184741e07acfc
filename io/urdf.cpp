// Makes an object of rigid bodies and joints of a robot description.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/joint.h"
#include "pliant/parse.h"
#include "scene_hints.h"
#include "scene_mesh.h"
#include "urdf_model.h"
#include "write_bodies.h"

namespace pliant {

namespace {

using urdf::Pose;

Quatf product(const Quatf& a, const Quatf& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Pose product(const Pose& a, const Pose& b) {
  return {a.position + output::turned(a.rotation, b.position), product(a.rotation, b.rotation)};
}

/// Inertia about the centre of mass, from the axes of `turn` to those of the link: R I R^T.
void turn_inertia(const Quatf& turn, Vec3f& moments, Vec3f& products) {
  const Vec3f axes[3] = {output::turned(turn, {1, 0, 0}), output::turned(turn, {0, 1, 0}),
                         output::turned(turn, {0, 0, 1})};
  const Vec3f rows[3] = {
      {moments.x, products.z, products.y}, {products.z, moments.y, products.x}, {products.y, products.x, moments.z}};
  const auto part = [](const Vec3f& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; };
  const auto element = [&](int i, int j) {
    float sum = 0;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) sum += part(axes[k], i) * part(rows[k], l) * part(axes[l], j);
    return sum;
  };
  const Vec3f turned_products{element(1, 2), element(2, 0), element(0, 1)};
  moments = {element(0, 0), element(1, 1), element(2, 2)};
  products = turned_products;
}

/// "'a', 'b' and 'c'", or of many the first ones and a number.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  const std::size_t shown = names.size() > most ? most : names.size();
  std::string text;
  for (std::size_t i = 0; i < shown; ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + ("'" + names[i] + "'");
  return text + (shown < names.size() ? " and " + std::to_string(names.size() - shown) + " more" : "");
}

/// Makes the object. Bodies are links; links without mass that a fixed joint holds belong to their parent's body.
class RobotBuilder {
 public:
  /// `path` names the file in errors; `home` is the folder of the meshes.
  RobotBuilder(urdf::Robot robot, const std::string& path, std::string home, const UrdfOptions& options,
               std::vector<std::string>& warnings)
      : path_(path), home_(std::move(home)), options_(options), warnings_(warnings), robot_(std::move(robot)) {}

  Object build() {
    object_.name = robot_.name;
    require_targets();
    require_mimicked();
    index_links();
    const std::size_t root = root_link();
    const Quatf upright = options_.z_up ? rotation({1, 0, 0}, -90) : Quatf{};
    add_tree(root, product(Pose{options_.position, options_.rotation}, Pose{{}, upright}));
    set_colour();
    object_.collides = true;
    object_.self_collision = options_.self_collision;
    if (object_.bodies.empty())
      fail(robot_.links[root].line, "has no link with mass or geometry", "add inertial elements");
    return std::move(object_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& problem, const std::string& advice) const {
    throw Error({.file = path_, .line = line, .object = robot_.name, .element = {}}, problem, advice);
  }
  void warn(int line, const std::string& text) {
    warnings_.push_back(path_ + ":" + std::to_string(line) + ": " + text);
  }

  /// Refuses a target of a joint that is not there, or that no motor moves.
  void require_targets() const {
    for (const auto& [name, target] : options_.targets) {
      const auto is_it = [&, &wanted = name](const urdf::Joint& joint) { return joint.name == wanted; };
      const auto joint = std::find_if(robot_.joints.begin(), robot_.joints.end(), is_it);
      if (joint == robot_.joints.end()) {
        std::vector<std::string> names;
        for (const urdf::Joint& one : robot_.joints) names.push_back(one.name);
        const std::string near = scene_file::nearest_name(name, names);
        fail(0, "has no joint '" + name + "', for which there is a target",
             near.empty() ? "name a joint of the file" : "did you mean '" + near + "'?");
      }
      if (!has_target(*joint))
        fail(joint->line, "joint '" + name + "' is " + joint->type + ", so no motor moves it to a target",
             "remove the target; revolute, continuous and prismatic joints have motors");
      if (!joint->mimics.empty())
        fail(joint->line, "joint '" + name + "' mimics '" + joint->mimics + "', so it has no target of its own",
             "give the target to '" + joint->mimics + "'");
    }
  }

  /// Refuses a joint that mimics one that is not there or that no motor moves, or itself.
  void require_mimicked() const {
    for (const urdf::Joint& joint : robot_.joints) {
      const urdf::Joint* of = &joint;
      for (std::size_t steps = 0; !of->mimics.empty(); ++steps) {
        if (steps == robot_.joints.size())
          fail(joint.line, "joint '" + joint.name + "' mimics itself, by way of others",
               "let one joint lead the others");
        of = &mimicked_by(*of);
      }
    }
  }

  const urdf::Joint& mimicked_by(const urdf::Joint& joint) const {
    const auto is_it = [&](const urdf::Joint& other) { return other.name == joint.mimics; };
    const auto found = std::find_if(robot_.joints.begin(), robot_.joints.end(), is_it);
    if (found == robot_.joints.end())
      fail(joint.line, "joint '" + joint.name + "' mimics '" + joint.mimics + "', which is no joint",
           "name a joint of the file");
    if (!has_target(joint) || !has_target(*found))
      fail(joint.line,
           "joint '" + joint.name + "' (" + joint.type + ") cannot mimic '" + found->name + "' (" + found->type + ")",
           "revolute, continuous and prismatic joints can");
    return *found;
  }

  // ---------------------------------------------------------------- the tree

  void index_links() {
    for (std::size_t l = 0; l < robot_.links.size(); ++l)
      if (!links_.emplace(robot_.links[l].name, l).second)
        fail(robot_.links[l].line, "a second link '" + robot_.links[l].name + "'", "names of links differ");
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const urdf::Joint& joint = robot_.joints[j];
      if (joint.parent == joint.child)
        fail(joint.line, "joint '" + joint.name + "' joins link '" + joint.child + "' to itself", "name two links");
      for (const std::string& link : {joint.parent, joint.child})
        if (links_.count(link) == 0)
          fail(joint.line, "joint '" + joint.name + "' names no link: '" + link + "'", hint_for_link(link));
      if (!parents_.emplace(joint.child, j).second)
        fail(joint.line, "link '" + joint.child + "' has two parents", "URDF describes trees: remove a joint");
      children_[joint.parent].push_back(j);
    }
  }

  std::string hint_for_link(const std::string& wanted) const {
    std::vector<std::string> names;
    for (const urdf::Link& link : robot_.links) names.push_back(link.name);
    const std::string near = scene_file::nearest_name(wanted, names);
    return near.empty() ? "add the link" : "did you mean '" + near + "'?";
  }

  /// Throws an Error with the joints of the loop that is reached from a link by going to parents for ever.
  [[noreturn]] void fail_by_loop(std::string link) const {
    for (std::size_t i = 0; i < robot_.links.size(); ++i)
      link = robot_.joints[parents_.at(link)].parent;  // now in the loop
    std::set<std::size_t> joints;
    for (; joints.insert(parents_.at(link)).second;) link = robot_.joints[parents_.at(link)].parent;
    std::vector<std::string> names;
    names.reserve(joints.size());
    for (const std::size_t joint : joints) names.push_back(robot_.joints[joint].name);
    fail(robot_.joints[*joints.begin()].line, "joints " + listed(names) + " form a loop",
         "URDF describes trees: remove one of these joints");
  }

  std::size_t root_link() const {
    if (robot_.links.empty()) fail(1, "has no links", "add one");
    std::vector<std::size_t> roots;
    for (std::size_t l = 0; l < robot_.links.size(); ++l)
      if (parents_.count(robot_.links[l].name) == 0) roots.push_back(l);
    if (roots.empty()) fail_by_loop(robot_.links[0].name);
    if (roots.size() > 1)
      fail(robot_.links[roots[1]].line, "link '" + robot_.links[roots[1]].name + "' is joined to nothing",
           "add a joint");
    return roots[0];
  }

  /// Adds links from the root on, in the order of their joints. A loop apart from the root is never reached.
  void add_tree(std::size_t root, const Pose& pose) {
    struct Place {
      std::size_t link;
      Pose pose;
    };
    std::vector<Place> open{{root, pose}};
    std::size_t done = 0;
    for (; done < open.size(); ++done) {
      const Place at = open[done];
      const urdf::Link& link = robot_.links[at.link];
      add_link(link, at.pose);
      for (const std::size_t child : children_[link.name])
        open.push_back({links_.at(robot_.joints[child].child), product(at.pose, robot_.joints[child].origin)});
    }
    if (done == robot_.links.size()) return;
    for (const urdf::Link& link : robot_.links)
      if (bodies_.count(link.name) == 0) fail_by_loop(link.name);
  }

  void add_link(const urdf::Link& link, const Pose& pose) {
    const auto joint = parents_.find(link.name);
    const urdf::Joint* to_parent = joint == parents_.end() ? nullptr : &robot_.joints[joint->second];
    const bool is_empty = !(link.inertial && link.inertial->mass > 0) && link.collision.empty() && link.visual.empty();
    const bool is_held = to_parent == nullptr || to_parent->type == "fixed";
    if (is_empty && is_held) {  // a frame of its parent; an empty root is the world
      bodies_[link.name] = to_parent == nullptr ? -1 : bodies_.at(to_parent->parent);
      return;
    }
    try {
      const std::vector<Solid> solids = solids_of(link);
      if (solids.empty() && !is_empty) warn_of_no_shape(link);
      bodies_[link.name] = add_body(object_, solids, options_of(link, pose, is_empty));
    } catch (const Error& error) {
      if (!error.where().file.empty()) throw;
      fail(link.line, "link '" + link.name + "': " + error.where().element + " " + error.problem(), error.advice());
    }
    if (to_parent != nullptr) return add_joint_of(*to_parent, pose);
    if (options_.fixed_base) add_joint(object_, FixedJoint{-1, bodies_.at(link.name), pose.position, {.name = "base"}});
  }

  // ---------------------------------------------------------------- bodies

  BodyOptions options_of(const urdf::Link& link, const Pose& pose, bool is_empty) {
    BodyOptions options;
    options.name = link.name == "world" ? "world link" : link.name;
    options.position = pose.position;
    options.rotation = pose.rotation;
    if (link.inertial && link.inertial->mass > 0) {
      BodyInertia inertia{link.inertial->mass, link.inertial->origin.position, link.inertial->moments,
                          link.inertial->products};
      turn_inertia(link.inertial->origin.rotation, inertia.moments, inertia.products);
      options.inertia = inertia;
    } else if (is_empty) {
      warn(link.line,
           "link '" + link.name + "' moves but has no mass; it gets 1 g and the inertia of a ball of 1 cm, no shape");
      options.inertia = BodyInertia{0.001f, {}, {4e-8f, 4e-8f, 4e-8f}, {}};
    } else {
      warn(link.line, "link '" + link.name + "' has no mass; it gets that of its shapes at 1000 kg/m^3");
    }
    return options;
  }

  void warn_of_no_shape(const urdf::Link& link) {
    const bool has_none = link.collision.empty() && link.visual.empty();
    warn(link.line, "link '" + link.name + "' has mass but no " +
                        (has_none ? "collision or visual shape" : "shape that can be read") +
                        ", so it touches nothing and is not drawn");
  }

  /// The shapes of collision, or if there are none those of pictures.
  std::vector<Solid> solids_of(const urdf::Link& link) {
    std::vector<Solid> solids;
    for (const urdf::Geometry& geometry : link.collision.empty() ? link.visual : link.collision) {
      Solid solid;
      solid.position = geometry.origin.position;
      solid.rotation = geometry.origin.rotation;
      if (set_shape(link, geometry, solid)) solids.push_back(std::move(solid));
    }
    return solids;
  }

  bool set_shape(const urdf::Link& link, const urdf::Geometry& geometry, Solid& solid) {
    const Vec3f& size = geometry.size;
    const Quatf along_z = rotation({1, 0, 0}, 90);  // from y, the axis of our shapes
    switch (geometry.kind) {
      case urdf::Geometry::Kind::box:
        solid.shape = Box{size * 0.5f};
        return true;
      case urdf::Geometry::Kind::sphere:
        solid.shape = Sphere{size.x};
        return true;
      case urdf::Geometry::Kind::cylinder:
        solid.shape = Cylinder{size.x, 0.5f * size.y};
        break;
      case urdf::Geometry::Kind::capsule:
        solid.shape = Capsule{size.x, 0.5f * size.y};
        break;
      case urdf::Geometry::Kind::mesh:
        return set_hull(link, geometry, solid);
    }
    solid.rotation = product(solid.rotation, along_z);
    return true;
  }

  bool set_hull(const urdf::Link& link, const urdf::Geometry& geometry, Solid& solid) {
    const std::string mesh = "mesh '" + geometry.file + "' of link '" + link.name + "'";
    if (const auto given = options_.meshes.find(geometry.file); given != options_.meshes.end()) {
      solid.shape = hull_of(geometry, mesh, given->second.positions);
      return true;
    }
    std::string suffix = std::filesystem::path(geometry.file).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (suffix != ".obj" && suffix != ".ply" && suffix != ".stl") {
      warn(geometry.line, mesh + " is ignored: only .obj, .ply and .stl can be read");
      return false;
    }
    const std::string file = found_file(geometry.file);
    if (!options_.allow_outside && !scene_file::lies_below(file, home_))
      fail(geometry.line, mesh + " leaves the folder of the file", "put it there, or permit files outside");
    if (!std::filesystem::is_regular_file(file)) {
      warn(geometry.line, mesh + " is ignored: there is no file '" + file + "'" + other_places(geometry.file));
      return false;
    }
    solid.shape = hull_of(geometry, mesh, read_mesh(file).positions);
    return true;
  }

  Hull hull_of(const urdf::Geometry& geometry, const std::string& mesh, std::vector<Vec3f> points) const {
    const Vec3f& scale = geometry.scale;
    for (Vec3f& p : points) p = {p.x * scale.x, p.y * scale.y, p.z * scale.z};
    Hull hull{std::move(points), 0};
    try {
      hull.points = mesh_of({{hull}}).positions;  // its corners alone
    } catch (const Error& error) {
      fail(geometry.line, mesh + ": " + error.problem(), error.advice());
    }
    return hull;
  }

  static constexpr const char* package_ = "package://";

  bool is_searched(const std::string& name) const { return name.rfind(package_, 0) == 0 && options_.packages.empty(); }

  /// Where else a missing mesh was sought.
  std::string other_places(const std::string& name) const {
    if (!is_searched(name)) return {};
    return ", and no '" + name.substr(std::string(package_).size()) + "' in this folder or one above";
  }

  /// "package://NAME/PATH" is PATH in the option's folder of packages, else in the nearest folder above the file that
  /// has it.
  std::string found_file(const std::string& name) const {
    namespace fs = std::filesystem;
    const std::string file = "file://";
    if (name.rfind(file, 0) == 0) return name.substr(file.size());
    if (name.rfind(package_, 0) != 0) return fs::path(name).is_absolute() ? name : (fs::path(home_) / name).string();
    const std::string inside = name.substr(std::string(package_).size());
    if (!options_.packages.empty()) return (fs::path(options_.packages) / inside).string();
    const std::string rest = inside.substr(std::min(inside.size(), inside.find('/') + 1));
    for (fs::path folder = fs::absolute(home_).lexically_normal(); folder.has_relative_path();
         folder = folder.parent_path())
      for (const std::string& tail : {inside, rest})
        if (fs::is_regular_file(folder / tail)) return (folder / tail).string();
    return (fs::path(home_) / rest).string();
  }

  void set_colour() {
    for (const urdf::Link& link : robot_.links) {
      if (!link.colour) continue;
      const auto linear = [](float c) {
        return std::clamp(c, 0.f, 1.f) * std::clamp(c, 0.f, 1.f);
      };  // from sRGB, nearly
      object_.colour = {linear(link.colour->x), linear(link.colour->y), linear(link.colour->z)};
      return;
    }
  }

  // ---------------------------------------------------------------- joints

  void add_joint_of(const urdf::Joint& joint, const Pose& pose) {
    const int a = bodies_.at(joint.parent), b = bodies_.at(joint.child);
    const Vec3f axis = output::turned(pose.rotation, joint.axis);
    JointOptions named;
    named.name = joint.name;
    try {
      if (joint.type == "fixed") {
        add_joint(object_, FixedJoint{a, b, pose.position, named});
      } else if (joint.type == "revolute" || joint.type == "continuous") {
        add_joint(object_,
                  HingeJoint{a, b, pose.position, axis, joint.type == "revolute" ? limit_of(joint, 6.2831855f) : none_,
                             motor_of(joint), joint.friction, named, joint.damping});
      } else if (joint.type == "prismatic") {
        add_joint(object_, SliderJoint{a, b, pose.position, axis, limit_of(joint, 1e6f), motor_of(joint),
                                       joint.friction, named, joint.damping});
      } else if (joint.type == "planar") {
        if (joint.friction != 0 || joint.damping != 0 || joint.has_limit)
          warn(joint.line, "friction, damping and limits of the planar joint '" + joint.name + "' are ignored");
        add_joint(object_, PlanarJoint{.a = a, .b = b, .anchor = pose.position, .normal = axis, .options = named});
      } else if (joint.type != "floating") {
        fail(joint.line, "joint '" + joint.name + "' has the unknown type '" + joint.type + "'",
             "known are fixed, revolute, continuous, prismatic, planar and floating");
      }
    } catch (const Error& error) {
      if (!error.where().file.empty()) throw;
      fail(joint.line, "joint '" + joint.name + "' " + error.problem(), error.advice());
    }
  }

  std::optional<JointRange> limit_of(const urdf::Joint& joint, float widest) {
    if (!joint.has_limit) {
      warn(joint.line, "joint '" + joint.name + "' has no limits");
      return {};
    }
    if (joint.upper - joint.lower <= widest) return JointRange{joint.lower, joint.upper};
    warn(joint.line, "joint '" + joint.name + "' has limits more than a turn apart, which are ignored");
    return {};
  }

  /// The target of a joint, or what follows from that of the joint that it mimics.
  std::optional<float> target_of(const urdf::Joint& joint) const {
    if (!joint.mimics.empty()) {
      const std::optional<float> leading = target_of(mimicked_by(joint));
      if (!leading) return {};
      return joint.multiplier * *leading + joint.offset;
    }
    const auto target = options_.targets.find(joint.name);
    if (target == options_.targets.end()) return {};
    return target->second;
  }

  /// Where a joint is held without a target: at 0, or at what follows from the joint that it mimics.
  float held_position(const urdf::Joint& joint) const {
    return joint.mimics.empty() ? 0 : joint.multiplier * held_position(mimicked_by(joint)) + joint.offset;
  }

  void warn_of_mimic(const urdf::Joint& joint, bool has_motor) {
    const std::string follows = "joint '" + joint.name + "' mimics '" + joint.mimics + "' ";
    warn(joint.line,
         follows + (has_motor ? "by the target of its motor alone, which does not follow when it is changed later"
                              : "without a motor, so it moves freely"));
  }

  /// A servo that holds the joint, or moves it to a target, with the effort and speed that the file gives.
  std::optional<JointMotor> motor_of(const urdf::Joint& joint) {
    const std::optional<float> target = target_of(joint);
    const bool is_driven = options_.motors || target.has_value();
    const bool can_be = is_driven && joint.effort && *joint.effort > 0;
    if (!joint.mimics.empty()) warn_of_mimic(joint, can_be);
    if (is_driven && !can_be)
      warn(joint.line, "joint '" + joint.name + "' has " + (joint.effort ? "an effort limit of 0" : "no effort limit") +
                           ", so it gets no motor" + (target ? ", and its target is ignored" : ""));
    if (!can_be) return {};
    JointMotor motor;
    motor.kind = JointMotor::Kind::position;
    motor.target = target.value_or(joint.mimics.empty() ? 0 : held_position(joint));
    motor.most = *joint.effort;
    if (joint.velocity > 0) motor.most_speed = joint.velocity;
    return motor;
  }

  const std::string& path_;
  std::string home_;
  const UrdfOptions& options_;
  std::vector<std::string>& warnings_;
  urdf::Robot robot_;
  Object object_;
  std::map<std::string, std::size_t> links_, parents_;  // indices of links; of the joint to each link's parent
  std::map<std::string, std::vector<std::size_t>> children_;
  std::map<std::string, int> bodies_;  // of each link; -1: the world
  const std::optional<JointRange> none_{};
};

}  // namespace

Object read_urdf(const std::string& path, const UrdfOptions& options, std::vector<std::string>* warnings) {
  std::vector<std::string> ignored;
  std::vector<std::string>& into = warnings != nullptr ? *warnings : ignored;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return RobotBuilder(urdf::read(path, into), path, folder.empty() ? "." : folder, options, into).build();
}

Object parse_urdf(std::string_view text, const std::string& name, const std::string& folder, const UrdfOptions& options,
                  std::vector<std::string>* warnings) {
  std::vector<std::string> ignored;
  std::vector<std::string>& into = warnings != nullptr ? *warnings : ignored;
  return RobotBuilder(urdf::parse(text, name, into), name, folder.empty() ? "." : folder, options, into).build();
}

}  // namespace pliant
