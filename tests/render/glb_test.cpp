// Tests that pictures of .glb files show what the World showed that wrote them, and that damaged files are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "io/write_support.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "render/glb.h"

namespace pliant::render {
namespace {

constexpr const char* some_of_all = R"({"objects": [
  {"cloth": {"mesh": {"grid": {"columns": 5, "rows": 4, "width": 1, "depth": 1}, "translate": [0, 2, 0]}},
   "colour": [0.25, 0.5, 0.75]},
  {"rope": {"points": [[0, 1, 0], [0.1, 1, 0], [0.2, 1, 0]]}, "pins": [{"particles": [0]}]},
  {"bodies": [{"solids": [{"box": {"half_extents": [0.1, 0.2, 0.3]}}], "position": [2, 1, 0],
               "angular_velocity": [1, 8, 2]}]},
  {"particles": {"positions": [[5, 1, 0], [5, 2, 0], [6, 1, 1]], "masses": 1}}], "colliders": [{"plane": {}}]})";

void expect_near(const std::vector<Vec3f>& found, const std::vector<Vec3f>& wanted, const char* what) {
  ASSERT_EQ(found.size(), wanted.size()) << what;
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_LT(length_squared(found[i] - wanted[i]), 1e-11f) << what << " " << i;
}

/// The middle of the box around points.
Vec3f middle(const std::vector<Vec3f>& points) {
  Vec3f low = points.front(), high = low;
  for (const Vec3f& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return (low + high) * 0.5f;
}

class Glb : public testing::Test {
 protected:
  /// Writes five frames, and returns what each showed.
  std::vector<RenderScene> write_frames() {
    const Scene scene = parse_scene(some_of_all, "s.json", ".");
    World world(scene);
    const auto writer = make_frame_writer(path_, scene, world);
    std::vector<RenderScene> shown;
    for (int frame = 0; frame < 5; ++frame) {
      if (frame > 0) world.step(1.f / 30);
      writer->add(world);
      shown.push_back(make_render_scene(scene, world));
    }
    writer->finish();
    return shown;
  }

  const test::Folder folder_;
  const std::string path_ = folder_ / "a.glb";
};

TEST_F(Glb, ShowsEachFrameAsTheWorldDid) {
  const std::vector<RenderScene> wanted = write_frames();
  const GlbFile file(path_);
  ASSERT_EQ(file.last_frame(), 4);
  EXPECT_NEAR(file.frame_time(), 1.0 / 30, 1e-6);
  for (int frame = 0; frame <= 4; ++frame) {
    SCOPED_TRACE(frame);
    const RenderScene found = file.frame(frame);
    const RenderScene& as = wanted[static_cast<std::size_t>(frame)];
    ASSERT_EQ(found.meshes.size(), 2u) << "the cloth and the body";
    expect_near(found.meshes[0].positions, as.meshes[0].positions, "cloth");
    EXPECT_EQ(found.meshes[0].triangles, as.meshes[0].triangles);
    EXPECT_EQ(found.meshes[0].colour, (Vec3f{0.25f, 0.5f, 0.75f}));
    ASSERT_EQ(found.tubes.size(), 1u);
    expect_near(found.tubes[0].points, as.tubes[0].points, "rope");
    ASSERT_EQ(found.balls.size(), 1u);
    expect_near(found.balls[0].centres, as.balls[0].centres, "particles");
    EXPECT_NEAR(std::sqrt(length_squared(middle(found.meshes[1].positions) - as.bodies[0].pose.position)), 0, 1e-5f);
    EXPECT_EQ(found.ground, 0.f);
  }
}

TEST_F(Glb, IsRefusedWhereverItIsCutOff) {
  write_frames();
  const std::string bytes = test::read(path_);
  for (std::size_t size = 0; size < bytes.size(); size += size < 200 ? 1 : 97) {
    std::ofstream(path_, std::ios::binary) << bytes.substr(0, size);
    EXPECT_THROW(GlbFile(path_).frame(0), Error) << size;
  }
}

/// A changed byte may do no harm, but whatever it does is an Error that names the file.
TEST_F(Glb, SurvivesEveryChangedByteOfItsText) {
  write_frames();
  const std::string bytes = test::read(path_);
  const std::size_t text = 20 + test::value_at<unsigned>(bytes, 12);
  int refused = 0;
  for (std::size_t at = 0; at < text; ++at) {
    std::string changed = bytes;
    changed[at] = changed[at] >= '0' && changed[at] < '9' ? static_cast<char>(changed[at] + 1) : '9';
    std::ofstream(path_, std::ios::binary) << changed;
    try {
      const GlbFile file(path_);
      for (int frame = 0; frame <= file.last_frame(); ++frame) (void)file.frame(frame);
    } catch (const Error& error) {
      EXPECT_EQ(error.where().file, path_) << at;
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace pliant::render
