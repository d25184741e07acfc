// pliant render: a scene as a picture or a movie, drawn without a screen.
//
// A movie keeps one camera, which must show the whole motion; so it is simulated twice, first to see how far things go.
// That is cheap beside drawing, and the same bits come out both times.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>

#include "apps/render/render.h"
#include "command.h"
#include "output.h"
#include "pliant/error.h"
#include "simulate.h"

namespace pliant::command {

namespace {

using pliant::render::Camera;
using pliant::render::make_render_scene;
using pliant::render::MovieWriter;
using pliant::render::Renderer;
using pliant::render::RenderScene;

struct Size {
  int width, height;
};

Size parse_size(const std::string& text) {
  Size size{};
  const char* end = text.data() + text.size();
  const auto [after_width, width_error] = std::from_chars(text.data(), end, size.width);
  if (width_error == std::errc() && after_width != end && (*after_width == 'x' || *after_width == 'X')) {
    const auto [after_height, height_error] = std::from_chars(after_width + 1, end, size.height);
    if (height_error == std::errc() && after_height == end) return size;
  }
  throw Error({}, "--size " + text + " is no size", "give width and height in pixels, as 1280x720");
}

void draw_picture(const RenderOptions& options, const Scene& scene, Size size) {
  Renderer renderer(size.width, size.height);
  World world(scene);
  simulate_finite(world, scene, options.scene, options.quiet, [] {});
  RenderScene picture = make_render_scene(scene, world);
  picture.camera = pliant::render::frame_camera({picture}, size.width, size.height, options.azimuth, options.elevation);
  pliant::render::write_png(options.out, size.width, size.height, renderer.draw(picture));
}

// A camera that shows the scene at the start, at the end and at some moments between.
Camera camera_for(const RenderOptions& options, const Scene& scene, World& world, Size size) {
  const int every = std::max(1, scene.frames / 24);
  const State start = world.state();
  std::vector<RenderScene> moments{make_render_scene(scene, world)};
  int frame = 0;
  simulate_finite(world, scene, options.scene, true, [&] {
    ++frame;
    if (frame % every == 0 || frame == scene.frames) moments.push_back(make_render_scene(scene, world));
  });
  world.restore(start);
  return pliant::render::frame_camera(moments, size.width, size.height, options.azimuth, options.elevation);
}

void draw_movie(const RenderOptions& options, const Scene& scene, Size size) {
  Renderer renderer(size.width, size.height);
  const double rate = std::clamp(1.0 / static_cast<double>(scene.frame_time), 1.0, 240.0);
  MovieWriter movie(options.out, size.width, size.height, rate);
  World world(scene);
  const Camera camera = camera_for(options, scene, world, size);
  const auto draw = [&] {
    RenderScene picture = make_render_scene(scene, world);
    picture.camera = camera;
    movie.add(renderer.draw(picture));
  };
  draw();
  simulate_finite(world, scene, options.scene, options.quiet, draw);
  movie.finish();
}

}  // namespace

int render(const RenderOptions& options) {
  const bool is_movie = has_suffix(options.out, ".mp4");
  if (!is_movie && !has_suffix(options.out, ".png")) {
    Location where;
    where.file = options.out;
    throw Error(where, "is neither .png nor .mp4", "give --out one of these suffixes; geometry is what pliant run writes");
  }
  const Size size = parse_size(options.size);
  const Scene scene = read_scene_with(options.scene, options.overrides);
  if (is_movie) {
    draw_movie(options, scene, size);
  } else {
    draw_picture(options, scene, size);
  }
  if (!options.quiet) print("wrote " + one_line(options.out) + "\n");
  return 0;
}

}  // namespace pliant::command
