// pliant render: a scene as a picture or a movie, drawn without a display.
//
// A movie has one fixed camera and extent, which must show the whole motion. So the scene is simulated twice, first to
// find them: simulation takes little time compared with drawing, and both runs give the same bits. A strip of pictures
// has one camera and extent too, so that only the objects differ.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>

#include "apps/command_line/output.h"
#include "apps/command_line/simulate.h"
#include "apps/render/render.h"
#include "command.h"
#include "pliant/error.h"

namespace pliant::command {

namespace {

using pliant::render::Camera;
using pliant::render::Extent;
using pliant::render::make_render_scene;
using pliant::render::MovieWriter;
using pliant::render::Renderer;
using pliant::render::RenderScene;

struct Size {
  int width, height;
};

/// What all pictures of a movie or strip share.
struct View {
  Camera camera;
  Extent extent;

  void apply(RenderScene& scene) const {
    scene.camera = camera;
    scene.extent = extent;
  }
};

View view_of(const std::vector<RenderScene>& moments, const RenderOptions& options, int width, int height) {
  return {pliant::render::frame_camera(moments, width, height, options.azimuth, options.elevation),
          pliant::render::extent_of(moments)};
}

Size parse_size(const std::string& text) {
  Size size{};
  const char* end = text.data() + text.size();
  const auto [after_width, width_error] = std::from_chars(text.data(), end, size.width);
  if (width_error == std::errc() && after_width != end && (*after_width == 'x' || *after_width == 'X')) {
    const auto [after_height, height_error] = std::from_chars(after_width + 1, end, size.height);
    if (height_error == std::errc() && after_height == end) return size;
  }
  throw Error({}, "--size " + text + " is not a size", "give width and height in pixels, such as 1280x720");
}

void draw_picture(const RenderOptions& options, const Scene& scene, Size size) {
  Renderer renderer(size.width, size.height);
  World world = make_world(scene, options.scene);
  simulate_finite(world, scene, options.scene, options.quiet, [] {});
  RenderScene picture = make_render_scene(scene, world);
  view_of({picture}, options, size.width, size.height).apply(picture);
  pliant::render::write_png(options.out, size.width, size.height, renderer.draw(picture));
}

// The scene after each requested frame, in the order of the request.
std::vector<RenderScene> moments_of(const RenderOptions& options, Scene scene) {
  scene.frames = *std::max_element(options.strip.begin(), options.strip.end());
  std::vector<RenderScene> moments(options.strip.size());
  World world = make_world(scene, options.scene);
  const auto keep = [&](int frame) {
    for (std::size_t i = 0; i < moments.size(); ++i)
      if (options.strip[i] == frame) moments[i] = make_render_scene(scene, world);
  };
  int frame = 0;
  keep(frame);
  simulate_finite(world, scene, options.scene, options.quiet, [&] { keep(++frame); });
  return moments;
}

void draw_strip(const RenderOptions& options, const Scene& scene, Size size) {
  constexpr int gap = 4;  // white pixels between two pictures
  const int count = static_cast<int>(options.strip.size());
  const int panel = (size.width - gap * (count - 1)) / count;
  Renderer renderer(panel, size.height);
  std::vector<RenderScene> moments = moments_of(options, scene);
  const View view = view_of(moments, options, panel, size.height);
  const std::size_t row = std::size_t{3} * static_cast<std::size_t>(size.width);
  std::vector<std::uint8_t> strip(row * static_cast<std::size_t>(size.height), 255);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    view.apply(moments[i]);
    const std::vector<std::uint8_t> pixels = renderer.draw(moments[i]);
    const std::size_t panel_row = std::size_t{3} * static_cast<std::size_t>(panel);
    const std::size_t left = i * (panel_row + std::size_t{3} * gap);
    for (std::size_t y = 0; y < static_cast<std::size_t>(size.height); ++y)
      std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(y * panel_row), panel_row,
                  strip.begin() + static_cast<std::ptrdiff_t>(y * row + left));
  }
  pliant::render::write_png(options.out, size.width, size.height, strip);
}

// A view that shows the scene at the start, at the end and at some times between.
View view_of_movie(const RenderOptions& options, const Scene& scene, Size size) {
  const int every = std::max(1, scene.frames / 24);
  World world = make_world(scene, options.scene);  // its own: once something is torn, the start cannot be restored
  std::vector<RenderScene> moments{make_render_scene(scene, world)};
  int frame = 0;
  simulate_finite(world, scene, options.scene, true, [&] {
    ++frame;
    if (frame % every == 0 || frame == scene.frames) moments.push_back(make_render_scene(scene, world));
  });
  return view_of(moments, options, size.width, size.height);
}

void draw_movie(const RenderOptions& options, const Scene& scene, Size size) {
  Renderer renderer(size.width, size.height);
  const double rate = std::clamp(1.0 / static_cast<double>(scene.frame_time), 1.0, 240.0);
  MovieWriter movie(options.out, size.width, size.height, rate);
  const View view = view_of_movie(options, scene, size);
  World world = make_world(scene, options.scene);
  const auto draw = [&] {
    RenderScene picture = make_render_scene(scene, world);
    view.apply(picture);
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
    throw Error(where, "is neither .png nor .mp4", "give --out one of these suffixes; for geometry use pliant run");
  }
  if (!options.strip.empty() && (is_movie || options.frame)) {
    throw Error(
        {},
        std::string("--strip draws ") + (is_movie ? "a picture, not a movie" : "several frames, so it excludes --frame"),
        "give --out a name that ends in .png, and the frames to --strip alone");
  }
  const Size size = parse_size(options.size);
  refuse_same_file_twice({options.scene}, {options.out});
  refuse_unwritable(options.out);
  Scene scene = read_scene_with(options.scene, options.overrides, options.quiet);
  for (const int frame : options.strip) require_frame(scene, options.scene, frame);
  if (options.frame) require_frame(scene, options.scene, *options.frame);
  scene.frames = options.frame.value_or(scene.frames);
  make_folder_of(options.out);
  if (is_movie) {
    draw_movie(options, scene, size);
  } else if (!options.strip.empty()) {
    draw_strip(options, scene, size);
  } else {
    draw_picture(options, scene, size);
  }
  if (!options.quiet) print("wrote " + one_line(options.out) + "\n");
  return 0;
}

}  // namespace pliant::command
