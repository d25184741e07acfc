// Tests everything that can be wrong in a scene, and the text of the error.
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/scene_check.h"
#include "io/scene_grammar.h"
#include "io/scene_hints.h"
#include "io/scene_json.h"
#include "scene_support.h"

namespace pliant {
namespace {

using Json = nlohmann::ordered_json;
using test::scene_error;
using test::scene_message;

TEST(SceneRefusal, SaysWhatIsWrongAndWhatToDo) {
  EXPECT_EQ(scene_message("{\"objects\": [\n {\"cloht\": {}}]}"),
            "x.json:2:3: /objects/0/cloht: 'cloht' is unknown in object; did you mean 'cloth'?");
  EXPECT_EQ(scene_message(R"({"objects": [], "frames": 1.5})"),
            "x.json:1:27: /frames: expected an integer from 0 to 10000000, found 1.5");
  EXPECT_EQ(scene_message(R"({"objects": [], "objects": []})"),
            "x.json:1:17: /objects: 'objects' occurs twice; keep one of the two");
  EXPECT_EQ(scene_message("{}"), "x.json:1:1: /: 'objects' is missing; expected an array");
  EXPECT_EQ(scene_message("[]"), "x.json:1:1: /: expected an object (scene, with 'objects'), found an array");
  EXPECT_EQ(scene_message(R"({"objects": [], "wind": [5, 0, 0]})"),
            "x.json:1:25: /wind: expected an object (wind, with 'velocity' and 'air_density'), found an array");
  EXPECT_EQ(scene_message(R"({"objects": [{"friction": 0.5}]})"),
            "x.json:1:15: /objects/0/friction: 'friction' is unknown in object; did you mean 'static_friction'?");
  EXPECT_EQ(scene_message(R"({"objects": [{"cloth": {"stretch": 1e-4}}]})"),
            "x.json:1:36: /objects/0/cloth/stretch: expected 'rigid', or an object (stiffness, with 'compliance' or "
            "'stiffness'), found a number");
  EXPECT_EQ(
      scene_message(R"({"objects": [{}]})"),
      "x.json:1:14: /objects/0: the kind of this object is missing; "
      "give exactly one of 'cloth', 'soft_body', 'rope', 'rod', 'liquid', 'gas', 'tracers', 'grains', 'particles', "
      "'bodies' "
      "and 'urdf'");
  EXPECT_EQ(scene_message(R"({"objects": [], "colliders": [{"box": {}, "plane": {}}]})"),
            "x.json:1:31: /colliders/0: more than one kind is given; "
            "give exactly one of 'plane', 'sphere', 'capsule', 'box' and 'mesh'");
  EXPECT_EQ(scene_message(R"({"objects": [], "settings": {"gravity": 1}})"),
            "x.json:1:30: /settings/gravity: 'gravity' is unknown in settings; it is a member of scene");
}

TEST(SceneRefusal, SaysWhatAFillLacks) {
  const auto message = [](const std::string& fill) {
    return scene_message(R"({"objects": [{"name": "a", "liquid": {"spacing": 0.25, "fill": )" + fill + "}}]}");
  };
  const auto says = [&](const std::string& fill, const std::string& words) {
    EXPECT_NE(message(fill).find(words), std::string::npos) << message(fill);
  };
  says(R"({})", "give exactly one of 'min' and 'mesh'");
  says(R"({"min": [0, 0, 0]})", "has 'min' without 'max'; give both corners of the box");
  says(R"({"min": [0, 0, 0], "max": [1, 1, 1], "clearance": 0.1})", "is only for a mesh");
  says(R"({"min": [0, 0, 0], "max": [1, 1, 1], "seed": 1})", "has no 'jitter'");
  says(R"({"mesh": {"box": {"size": [1, 1, 1]}}, "max": [1, 1, 1]})", "is the corner of a box, but a mesh is filled");
  says(R"({"mesh": {"tube": {"columns": 6, "rows": 2, "length": 1, "top_radius": 1, "bottom_radius": 1}}})",
       "so the mesh is not closed");
  says(R"({"mesh": {"box": {"size": [1, 1, 1]}}, "clearance": 0.6})", "has no room for a particle");
  says(R"({"mesh": {"box": {"size": [1000, 1000, 1000]}}})", "more than");
}

TEST(SceneRefusal, SaysWhatARegionLacks) {
  const auto message = [](const std::string& box) {
    return scene_message(R"({"objects": [{"name": "a", "tracers": {"source": {"box": )" + box + "}}}]}");
  };
  EXPECT_NE(message(R"({"min": [0, 0, 0]})").find("max"), std::string::npos) << message(R"({"min": [0, 0, 0]})");
  EXPECT_NE(message(R"({"mesh": {"box": {"size": [1, 1, 1]}}})").find("mesh"), std::string::npos);
}

TEST(SceneRefusal, NamesThePlaceOfBoundsThatLeaveNoSubsteps) {
  EXPECT_EQ(scene_message("{\"objects\": [], \"settings\":\n {\"least_substeps\": 48, \"most_substeps\": 20}}"),
            "x.json:2:21: /settings/least_substeps: is 48, more than most_substeps, 20; "
            "increase most_substeps, or name a fixed number of substeps");
  EXPECT_EQ(scene_message(R"({"objects": [], "settings": {"substeps": 9, "least_substeps": 13, "most_substeps": 14}})"),
            "x.json:1:63: /settings/least_substeps: is 13 and most_substeps 14, but substeps that follow the State are "
            "multiples of four, and none lies between; "
            "increase most_substeps to 16, or remove both bounds: the scene names substeps");
}

/// Names that are right, or nearly right, elsewhere in the format.
TEST(SceneRefusal, KnowsWhereANameBelongs) {
  const auto hint = [](const std::string& scene) {
    const std::string message = scene_message(scene);
    return message.substr(std::min(message.size(), message.rfind("; ") + 2));
  };
  EXPECT_EQ(hint(R"({"objects": [], "substeps": 10})"), "it is a member of settings, as 'settings.substeps'");
  EXPECT_EQ(hint(R"({"objects": [], "substps": 10})"), "did you mean 'settings.substeps'?");
  EXPECT_EQ(hint(R"({"objects": [], "thethers": true})"), "did you mean 'settings.sweep_options.tethers'?");
  EXPECT_EQ(hint(R"({"objects": [{"substep": 10}]})"), "did you mean 'settings.substeps'?");
  EXPECT_EQ(hint(R"({"objects": [{"materail": "silk"}]})"), "did you mean 'cloth.material'?") << "below comes first";
  EXPECT_EQ(hint(R"({"objects": [{"material": "silk"}]})"), "it is a member of cloth, as 'cloth.material'");
  EXPECT_EQ(hint(R"({"objects": [], "self_colision": true})"), "did you mean 'objects[].self_collision'?");
  EXPECT_EQ(hint(R"({"objects": [], "settings": {"gravty": [0, 0, 0]}})"), "did you mean 'gravity' of the scene?");
  EXPECT_EQ(hint(R"({"objects": [], "settings": {"substep": 10}})"), "did you mean 'substeps'?")
      << "here comes before all";
  EXPECT_EQ(hint(R"({"objects": [], "sphere": {}})").rfind("it is a member of collider, as 'colliders[].sphere'", 0),
            0U);
  EXPECT_EQ(
      hint(R"({"objects": [{"rope": {"points": [[0, 0, 0], [1, 0, 0]]}, "pins": [{"particles": {"group": "a"}}]}]})"),
      "known are 'box' and 'nearest'")
      << "the groups of objects, which collide, are no selection";
  EXPECT_EQ(hint(R"({"objects": [{"bodies": [{"solids": [{"sphere": {}}]}], "joints": [
                    {"between": ["world", "body"], "ball": {"anchor": [0, 0, 0], "damping": 1}}]}]})"),
            "did you mean 'friction'?")
      << "the damping of an object is that of air";
  EXPECT_EQ(hint(R"({"objects": [{"bodies": [{"solids": [{"sphere": {}}], "orientation": [0, 0, 0]}]}]})"),
            "did you mean 'rotation'?");
  EXPECT_EQ(hint(R"({"objects": [], "wind": {"qzx": 1}})"),
            "known are 'velocity', 'air_density', 'gust' and 'gust_period'");
  EXPECT_EQ(hint(R"({"objects": [], "wind": {")" + std::string(65, 's') + R"(": 1}})").rfind("known are ", 0), 0U);
}

/// A JSON pointer as an Error shows it.
std::string shown(const Json::json_pointer& pointer) { return pointer.empty() ? "/" : pointer.to_string(); }

void expect_refused(const Json& scene, const Json::json_pointer& at, const std::string& what) {
  const Error error = scene_error(scene.dump(1));
  EXPECT_EQ(error.where().element, shown(at)) << what << ": " << error.what();
  EXPECT_GT(error.where().line, 0) << what;
  EXPECT_GT(error.where().column, 0) << what;
}

/// Calls `visit` with a pointer to every value below `at`.
template <class Visit>
void each_value(const Json& value, const Json::json_pointer& at, const Visit& visit) {
  visit(value, at);
  if (value.is_object())
    for (const auto& [key, item] : value.items()) each_value(item, at / key, visit);
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i) each_value(value[i], at / i, visit);
}

class EveryField : public testing::Test {
 protected:
  const Json scene = Json::parse(test::full_scene());
};

TEST_F(EveryField, IsAccepted) { EXPECT_EQ(scene_message(test::full_scene()), ""); }

TEST_F(EveryField, AppearsInTheTestScene) {
  const std::string text = test::full_scene();
  const auto needs_a_file = [](const std::string& name) { return name == "urdf" || name == "joint target"; };
  for (const scene_file::Record* record : scene_file::all_records()) {
    if (needs_a_file(record->name)) continue;
    for (const scene_file::Field& field : record->fields)
      EXPECT_TRUE(field.name == "file" || field.name == "urdf" || field.name == "array" ||
                  text.find('"' + field.name + '"') != std::string::npos)
          << field.name;
  }
}

TEST_F(EveryField, OfAWrongTypeIsNamed) {
  each_value(scene, Json::json_pointer(), [&](const Json& value, const Json::json_pointer& at) {
    Json changed = scene;
    changed[at] = nullptr;
    expect_refused(changed, at, "null");
    changed[at] = !value.is_boolean() ? Json(true) : Json(1);
    expect_refused(changed, at, "another type");
  });
}

TEST_F(EveryField, ThatIsHugeIsNamed) {
  each_value(scene, Json::json_pointer(), [&](const Json& value, const Json::json_pointer& at) {
    if (!value.is_number()) return;
    for (const double huge : {1e39, -1e39, 1e308}) {
      Json changed = scene;
      changed[at] = huge;
      expect_refused(changed, at, "huge");
    }
  });
}

TEST_F(EveryField, MeetsItsLimits) {
  each_value(scene, Json::json_pointer(), [&](const Json& value, const Json::json_pointer& at) {
    if (!value.is_number()) return;
    const std::string name = at.back();
    const bool may_be_negative = name.size() == 1 || name == "degrees" || name == "low" || name == "high" ||
                                 name == "speed" || name == "position" || name == "lift" || name == "start" ||
                                 name == "end" || name == "rest" || name == "torque" || name == "force" ||
                                 name == "target" || name == "azimuth" || name == "elevation" ||
                                 at.to_string().find("/helix/") !=
                                     std::string::npos;  // parts of vectors, rest data, joints, balloons, times, coils
    Json changed = scene;
    changed[at] = -0.001;
    const bool refused = std::string(scene_error(changed.dump()).what()) != "";
    EXPECT_TRUE(refused || may_be_negative) << shown(at);
  });
}

TEST_F(EveryField, ThatIsUnknownIsNamed) {
  each_value(scene, Json::json_pointer(), [&](const Json& value, const Json::json_pointer& at) {
    if (!value.is_object()) return;
    Json changed = scene;
    changed[at]["unknown_member"] = 1;
    expect_refused(changed, at / "unknown_member", "unknown");
  });
}

TEST_F(EveryField, ThatIsNotANumberIsRefusedWithItsPlace) {
  each_value(scene, Json::json_pointer(), [&](const Json& value, const Json::json_pointer& at) {
    if (!value.is_number()) return;
    Json changed = scene;
    changed[at] = "@";
    std::string text = changed.dump(1);
    const std::size_t place = text.find("\"@\"");
    const Error error = scene_error(text.replace(place, 3, "NaN"));
    EXPECT_NE(error.problem().find("not valid JSON"), std::string::npos) << shown(at);
    EXPECT_EQ(error.where().line, 1 + std::count(text.begin(), text.begin() + static_cast<long>(place), '\n'));
  });
}

/// Removes each member in turn: an Error must name those that the table calls required.
TEST_F(EveryField, ThatIsRequiredIsMissed) {
  int required = 0;
  const auto visit = [&](const Json& value, const Json::json_pointer& at) {
    if (!value.is_object()) return;
    for (const auto& [key, item] : value.items()) {
      Json changed = scene;
      changed[at].erase(key);
      const Error error = scene_error(changed.dump());
      if (error.problem().find("'" + key + "' is missing") == std::string::npos) continue;
      EXPECT_EQ(error.where().element, shown(at));
      ++required;
    }
  };
  each_value(scene, Json::json_pointer(), visit);
  EXPECT_GE(required, 40);
}

std::string cloth_with(const std::string& members) {
  return R"({"cloth": {"mesh": {"grid": {"columns": 3, "rows": 3, "width": 1, "depth": 1}}}, )" + members + "}";
}

TEST(SceneRefusal, NamesValuesThatContradictEachOther) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {cloth_with(R"("pins": [{"particles": [0, 9]}])"), "/objects/0/pins/0/particles/1: there is no particle 9"},
      {cloth_with(R"("pins": [{"particles": [1, 1]}])"), "/objects/0/pins/0/particles/1: particle 1 occurs twice"},
      {cloth_with(R"("pins": [{"particles": [1]}, {"particles": "all"}])"),
       "/objects/0/pins/1/particles: particle 1 is already pinned"},
      {cloth_with(R"("pins": [{"particles": {"box": {"min": [5, 5, 5], "max": [6, 6, 6]}}}])"),
       "/objects/0/pins/0/particles/box: there is no particle in this box; the one nearest to its centre is 8 at 0.5"},
      {cloth_with(R"("pins": [{"particles": {"box": {"min": [1, 0, 0], "max": [0, 0, 0]}}}])"),
       "/box: the box is empty"},
      {cloth_with(R"("pins": [{"particles": [0], "motion": {"keyframes": [{"time": 1}, {"time": 1}]}}])"),
       "/objects/0/pins/0/motion/keyframes/1/time: this time is not after the previous one"},
      {cloth_with(R"("static_friction": 0.2, "kinetic_friction": 0.3)"),
       "/objects/0/kinetic_friction: kinetic friction is larger"},
      {R"({"rope": {"points": [[0, 0, 0], [1, 0, 0]]}, "pins": [{"particles": "corners"}]})",
       "only a grid has corners"},
      {R"({"rope": {"points": [[0, 0, 0], [0, 0, 0]]}})", "object 'rope', /objects/0/rope, "},
      {R"({"particles": {"positions": [[0, 0, 0]], "masses": [1, 2]}})",
       "/objects/0/particles/masses: 2 masses for 1 particles"},
      {R"({"particles": {"positions": [[0, 0, 0]], "masses": 1, "triangles": [[0, 0, 3]]}})",
       "/triangles/0/2: there is no particle 3"},
      {R"({"particles": {"positions": [[0, 0, 0]], "masses": 1, "velocities": []}})", "0 velocities for 1 particles"},
      {R"({"particles": {"positions": [[0, 0, 0]], "masses": 1, "velocities": [[0, 0, 0]]}, "velocity": [1, 0, 0]})",
       "/objects/0/velocity: this object already has a velocity"},
      {R"({"particles": {"positions": [[0, 0, 0], [1, 0, 0]], "masses": 1, "constraints": [
           {"type": "distance", "particles": [[0, 1, 1]]}]}})",
       "/constraints/0/particles/0: 3 elements; a distance constraint takes 2"},
      {R"({"particles": {"positions": [[0, 0, 0], [1, 0, 0]], "masses": 1, "constraints": [
           {"type": "distance", "particles": [[0, 1]], "rest": []}]}})",
       "/rest: 0 elements for 1 constraints"},
      {R"({"particles": {"positions": [[0, 0, 0], [1, 0, 0]], "masses": 1, "constraints": [
           {"type": "distance", "particles": [[0, 1]], "stiffness": {"stiffness": 1}, "compliances": [1]}]}})",
       "/compliances: compliances cannot be combined with a PBD stiffness"},
      {R"({"particles": {"positions": [[0, 0, 0], [1, 0, 0]], "masses": 1, "constraints": [
           {"type": "distence", "particles": []}]}})",
       "there is no 'distence' here; did you mean 'distance'?"},
      {R"({"bodies": [{"solids": [{"sphere": {}}], "mass": "1kg"}]})",
       "/mass: there is no '1kg' here; expected a number above 0, up to 1e+30 [kg], or 'fixed'"},
      {R"({"name": "a", "rope": {"points": [[0, 0, 0], [1, 0, 0]]}}, {"name": "a", "rope": {"points": [[0, 0, 0], [1, 0, 0]]}})",
       "/objects/1/name: the name 'a' is taken"},
      {R"({"rope": {"points": [[0, 0, 0], [1, 0, 0]], "stretch": {"stiffness": 1, "damping": 1}}})",
       "/stretch/damping: damping needs a compliance"},
      {R"({"cloth": {"mesh": {"sphere": {"subdivisions": 0}, "rotate": {"axis": [0, 0, 0], "degrees": 1}}}})",
       "/rotate/axis: this axis has length 0"},
      {R"({"cloth": {"mesh": {"sphere": {"subdivisions": 0, "radius": 1e6}, "scale": 10}}})",
       "vertex 0 lies more than 1000 km"},
      {R"({"cloth": {"mesh": {"sphere": {"subdivisions": 0, "radius": 1e-60}}}})", "/radius: 1e-60 is out of range"},
      {R"({"cloth": {"mesh": {"grid": {"columns": 3, "rows": 3, "width": 1, "depth": 1}}, "volume": {}}})",
       "object 'cloth', /objects/0/cloth"},
  };
  for (const auto& [object, expected] : cases)
    EXPECT_NE(scene_message("{\"objects\": [" + object + "]}").find(expected), std::string::npos)
        << expected << "\nwas: " << scene_message("{\"objects\": [" + object + "]}");
}

TEST(SceneRefusal, StopsScenesThatWouldFillTheMemory) {
  std::string object = R"({"particles": {"positions": [[0, 0, 0]], "masses": 1}})";
  EXPECT_NE(scene_message(
                R"({"objects": [{"cloth": {"mesh": {"grid": {"columns": 1e9, "rows": 2, "width": 1, "depth": 1}}}}]})"),
            "");
  EXPECT_NE(scene_message(R"({"objects": [{"cloth": {"mesh": {"sphere": {"subdivisions": 8}}}}]})"), "");
  EXPECT_NE(
      scene_message(R"({"objects": [{"rope": {"line": {"from": [0,0,0], "to": [1,0,0], "points": 2147483647}}}]})"),
      "");
  EXPECT_EQ(scene_message("{\"objects\": [" + object + "]}"), "");
}

TEST(SceneRefusal, LeavesNothingUnread) {
  const auto document = scene_file::parse_json("{\"a\": [{\"b\": 1}]}", "x.json");
  EXPECT_THROW(scene_file::check_all_used(document), Error);
  const scene_file::JsonValue& list = *document.root.find("a");
  try {
    scene_file::check_all_used(document);
    ADD_FAILURE() << "nobody asked for b";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "x.json:1:9: /a/0/b: 'b' has no meaning here; remove it");
  }
  list.items.at(0).find("b");
  EXPECT_NO_THROW(scene_file::check_all_used(document));
}

TEST(SceneRefusal, CountsEditsAsAHandMakesThem) {
  using scene_file::edit_distance;
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("cloht", "cloth"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("friction", "fricton"), 1U);
  EXPECT_EQ(edit_distance("flaw", "lawn"), 2U);
  EXPECT_EQ(edit_distance("ca", "abc"), 3U);  // optimal string alignment edits no substring twice
}

// ---------------------------------------------------------------- files that a scene may name

class SceneFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "/pliant_scene_XXXXXX";
    folder = mkdtemp(pattern.data());
    std::filesystem::create_directory(folder / "in");
    write("in/a.obj");
    write("out.obj");
    std::filesystem::create_symlink("../out.obj", folder / "in/leaving.obj");
    std::filesystem::create_symlink("a.obj", folder / "in/staying.obj");
    std::filesystem::create_symlink("..", folder / "in/up");
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  void write(const char* name) { std::ofstream(folder / name) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"; }
  std::string problem(const std::string& file, bool allow_outside) {
    const std::string text = R"({"objects": [{"cloth": {"mesh": {"file": ")" + file + "\"}}}]}";
    return scene_error(text, folder / "in", allow_outside).problem();
  }

  std::filesystem::path folder;
};

TEST_F(SceneFiles, InTheSameFolderAreRead) {
  EXPECT_EQ(problem("a.obj", false), "");
  EXPECT_EQ(problem("./a.obj", false), "");
  EXPECT_EQ(problem("staying.obj", false), "");
}

TEST_F(SceneFiles, OutsideAreReadOnlyWhereAllowed) {
  for (const std::string& file :
       {std::string("../out.obj"), (folder / "out.obj").string(), (folder / "in/a.obj").string(),
        std::string("leaving.obj"), std::string("up/out.obj"), std::string("up/in/../out.obj")}) {
    EXPECT_NE(problem(file, false).find("leaves the scene's folder"), std::string::npos)
        << file << problem(file, false);
    EXPECT_EQ(problem(file, true), "") << file;
  }
}

TEST_F(SceneFiles, ThatAreNoFilesAreRefusedAtOnce) {
  ASSERT_EQ(mkfifo((folder / "in/pipe.obj").c_str(), 0600), 0);
  for (const bool allow_outside : {false, true}) {
    EXPECT_NE(problem("pipe.obj", allow_outside).find("not a regular file"), std::string::npos);
    EXPECT_NE(problem(".", allow_outside).find("not a regular file"), std::string::npos);
    EXPECT_NE(problem("missing.obj", allow_outside).find("there is no file"), std::string::npos);
    for (const char* url : {"http://localhost/a.obj", "file:///etc/passwd", "data:text/plain,v"})
      EXPECT_NE(problem(url, allow_outside).find("URL"), std::string::npos) << url;
  }
  EXPECT_NE(problem("/dev/zero", true).find("not a regular file"), std::string::npos);
  EXPECT_NE(problem("a\\u0000.obj", true).find("control characters"), std::string::npos);
}

TEST_F(SceneFiles, AreRefusedAsScenesUnlessRegular) {
  const auto message = [](const std::string& path) {
    try {
      read_scene(path);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  ASSERT_EQ(mkfifo((folder / "pipe.json").c_str(), 0600), 0);
  EXPECT_EQ(message(folder / "pipe.json"),
            (folder / "pipe.json").string() + ": not a regular file; name a scene in JSON");
  EXPECT_EQ(message(folder / "none.json"),
            (folder / "none.json").string() +
                ": the file does not exist; check the path; a relative one starts at the current folder");
  EXPECT_NE(message("/dev/zero"), "");
  EXPECT_NE(message(folder), "");
}

}  // namespace
}  // namespace pliant
