// pliant render: a scene as a picture or a movie, drawn without a display.
//
// A movie has one fixed camera and extent, which must show the whole motion. So all of its pictures are made, as data,
// before the first is drawn. If they do not fit in memory, the scene is simulated twice: both runs give the same bits.
// A strip of pictures has one camera and extent too, so that only the objects differ.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
#include <set>

#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "apps/command_line/simulate.h"
#include "apps/render/render.h"
#include "checkpoint.h"
#include "command.h"
#include "pliant/error.h"

namespace pliant::command {

namespace {

using pliant::render::Camera;
using pliant::render::Extent;
using pliant::render::make_render_scene;
using pliant::render::MovieWriter;
using pliant::render::Quality;
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
  return {pliant::render::frame_camera(moments, width, height, options.camera), pliant::render::extent_of(moments)};
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

Quality quality_of(const RenderOptions& options) { return options.draft ? Quality::draft : Quality::full; }

/// The World at the start, or at the checkpoint.
Resumed start_to_draw(const RenderOptions& options, const Scene& scene) {
  if (options.resume.empty()) return {make_world(scene, options.scene), {}};
  try {
    return resume(options.resume, scene, options.scene);
  } catch (const Error& error) {
    throw of_file(error, options.resume);
  }
}

/// What to draw of a World. Where objects may have come apart, the contents of its checkpoint describe it.
RenderScene picture_of(const Resumed& at, const Scene& scene) {
  return make_render_scene(at.contents ? *at.contents : scene, at.world);
}

void draw_picture(const RenderOptions& options, Scene scene, Size size) {
  Renderer renderer(size.width, size.height, quality_of(options));
  Resumed at = start_to_draw(options, scene);
  const auto frame = static_cast<int>(at.world.state().frame);
  if (!options.resume.empty() && !options.frame) scene.frames = frame;
  if (frame > scene.frames)
    throw Error({.file = options.resume}, "is of frame " + std::to_string(frame) + ", after the frame to draw",
                "give --frame " + std::to_string(frame) + " or more, or none");
  simulate_finite(at.world, scene, options.scene, options.quiet, [] {});
  RenderScene picture = picture_of(at, scene);
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
  Renderer renderer(panel, size.height, quality_of(options));
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

/// Memory that a picture as data takes [bytes], roughly.
std::size_t size_of(const RenderScene& scene) {
  std::size_t triangles = 0, points = scene.bodies.size();
  const auto add = [&](const auto& mesh) {
    points += mesh.positions.size();
    triangles += mesh.triangles.size();
  };
  for (const auto& mesh : scene.meshes) {
    add(mesh);
    points += mesh.creased.size() + mesh.wetness.size();
  }
  std::set<const TriangleMesh*> shared;
  for (const auto& body : scene.bodies)
    if (shared.insert(body.mesh.get()).second) add(*body.mesh);
  for (const auto& tube : scene.tubes) points += tube.points.size();
  for (const auto& balls : scene.balls) points += balls.centres.size();
  for (const auto& smoke : scene.smokes) points += 2 * smoke.centres.size();
  return sizeof(Vec3f) * (points + triangles);
}

/// The pictures of a movie.
struct Reel {
  std::vector<RenderScene> all;   ///< in order; empty if they did not fit in memory
  std::vector<RenderScene> some;  ///< the first, the last and some between, which the camera shows
  bool is_whole = true;           ///< true: `all` has every picture
};

/// True if frame number `frame` is in a movie of every `every`-th frame.
bool is_in_movie(int frame, int every, const Scene& scene) { return frame % every == 0 || frame == scene.frames; }

/// Simulates the scene and keeps every `every`-th picture, all that fit in a gigabyte.
Reel make_reel(const RenderOptions& options, const Scene& scene, int every) {
  constexpr std::size_t most_bytes = std::size_t{1} << 30;
  const int some = std::max(1, scene.frames / 24);
  World world = make_world(scene, options.scene);  // its own: once something is torn, the start cannot be restored
  Reel reel;
  std::size_t bytes = 0;
  const auto keep = [&](int frame) {
    const bool is_some = is_in_movie(frame, some, scene), is_kept = reel.is_whole && is_in_movie(frame, every, scene);
    if (!is_some && !is_kept) return;
    RenderScene picture = make_render_scene(scene, world);
    if (is_some) {
      reel.some.push_back(picture);
      bytes += size_of(picture);
    }
    if (!is_kept) return;
    bytes += size_of(picture);
    reel.all.push_back(std::move(picture));
    if (bytes <= most_bytes) return;
    reel.is_whole = false;
    reel.all = {};
  };
  int frame = 0;
  keep(frame);
  simulate_finite(world, scene, options.scene, options.quiet, [&] { keep(++frame); });
  return reel;
}

void draw_movie(const RenderOptions& options, const Scene& scene, Size size) {
  constexpr double rate_of_draft = 15;
  Renderer renderer(size.width, size.height, quality_of(options));
  const double frames_a_second = 1.0 / static_cast<double>(scene.frame_time);
  const double skipped = std::clamp(frames_a_second / rate_of_draft, 1.0, 1e6);
  const int every = options.draft ? static_cast<int>(skipped + 0.5) : 1;
  MovieWriter movie(options.out, size.width, size.height, std::clamp(frames_a_second / every, 1.0, 240.0));
  Reel reel = make_reel(options, scene, every);
  const View view = view_of(reel.some, options, size.width, size.height);
  const auto add = [&](RenderScene& picture) {
    view.apply(picture);
    movie.add(renderer.draw(picture));
  };
  if (reel.is_whole) {
    for (RenderScene& picture : reel.all) {
      throw_if_interrupted();
      add(picture);
    }
  } else {
    World world = make_world(scene, options.scene);
    int frame = 0;
    const auto draw = [&] {
      if (!is_in_movie(frame++, every, scene)) return;
      RenderScene picture = make_render_scene(scene, world);
      add(picture);
    };
    draw();
    simulate_finite(world, scene, options.scene, options.quiet, draw);
  }
  movie.finish();
}

}  // namespace

int render(RenderOptions options) {
  const bool is_movie = has_suffix(options.out, ".mp4");
  if (!is_movie && !has_suffix(options.out, ".png")) {
    Location where;
    where.file = options.out;
    throw Error(where, "is neither .png nor .mp4", "give --out one of these suffixes; for geometry use pliant run");
  }
  if (!options.strip.empty() && (is_movie || options.frame)) {
    throw Error({},
                std::string("--strip draws ") +
                    (is_movie ? "a picture, not a movie" : "several frames, so it excludes --frame"),
                "give --out a name that ends in .png, and the frames to --strip alone");
  }
  if (!options.resume.empty() && (is_movie || !options.strip.empty()))
    throw Error({}, "--resume draws one picture", "give --out a name that ends in .png, and no --strip");
  const Size size = parse_size(!options.size.empty() ? options.size : options.draft ? "640x360" : "1280x720");
  refuse_same_file_twice({options.scene, options.resume}, {options.out});
  refuse_unwritable(options.out);
  SceneFile file = read_file_with(options.scene, options.overrides, options.quiet);
  options.camera = pliant::render::merged(options.camera, file.camera);
  Scene& scene = file.scene;
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
