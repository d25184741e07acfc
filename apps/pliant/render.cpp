// pliant render: a scene as a picture or a movie, drawn without a display.
//
// A movie has one fixed camera and extent, which must show the whole motion. So all of its pictures are made, as data,
// before the first is drawn. If they do not fit in memory, the scene is simulated twice: both runs give the same bits.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>

#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "apps/command_line/simulate.h"
#include "apps/render/glb.h"
#include "apps/render/render.h"
#include "checkpoint.h"
#include "command.h"
#include "pictures.h"
#include "pliant/error.h"

namespace pliant::command {

namespace {

using pliant::render::make_render_scene;
using pliant::render::RenderScene;

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

void draw_picture(const RenderOptions& options, Scene scene, const Size& size) {
  SideBySide picture(options, size, 1);
  Resumed at = start_to_draw(options, scene);
  const auto frame = static_cast<int>(at.world.state().frame);
  if (!options.resume.empty() && !options.frame) scene.frames = frame;
  if (frame > scene.frames)
    throw Error({.file = options.resume}, "is of frame " + std::to_string(frame) + ", after the frame to draw",
                "give --frame " + std::to_string(frame) + " or more, or none");
  simulate_finite(at.world, scene, options.scene, options.quiet, [] {});
  picture.draw({picture_of(at, scene)});
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

void draw_strip(const RenderOptions& options, const Scene& scene, const Size& size) {
  SideBySide strip(options, size, options.strip.size());
  strip.draw(moments_of(options, scene));
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

/// True if a movie of every `every`-th frame up to `last` has this one.
bool is_in_movie(int frame, int every, int last) { return frame % every == 0 || frame == last; }

bool is_movie(const RenderOptions& options) { return has_suffix(options.out, ".mp4"); }
bool is_glb(const RenderOptions& options) { return has_suffix(options.scene, ".glb"); }

/// Simulates the scene and keeps every `every`-th picture, all that fit in a gigabyte.
Reel make_reel(const RenderOptions& options, const Scene& scene, int every) {
  constexpr std::size_t most_bytes = std::size_t{1} << 30;
  const int some = std::max(1, scene.frames / 24);
  World world = make_world(scene, options.scene);  // its own: once something is torn, the start cannot be restored
  Reel reel;
  std::size_t bytes = 0;
  const auto keep = [&](int frame) {
    const bool is_some = is_in_movie(frame, some, scene.frames),
               is_kept = reel.is_whole && is_in_movie(frame, every, scene.frames);
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

void draw_movie(const RenderOptions& options, const Scene& scene, const Size& size) {
  Movie movie(options, size, static_cast<double>(scene.frame_time));
  const int every = movie.every();
  Reel reel = make_reel(options, scene, every);
  movie.see(reel.some);
  if (reel.is_whole) {
    for (RenderScene& picture : reel.all) {
      throw_if_interrupted();
      movie.add(std::move(picture));
    }
  } else {
    World world = make_world(scene, options.scene);
    int frame = 0;
    const auto draw = [&] {
      if (is_in_movie(frame++, every, scene.frames)) movie.add(make_render_scene(scene, world));
    };
    draw();
    simulate_finite(world, scene, options.scene, options.quiet, draw);
  }
  movie.finish();
}

/// Draws a scene that is simulated.
void draw_scene(RenderOptions options, const Size& size) {
  SceneFile file = read_file_with(options.scene, options.overrides, options.quiet);
  options.camera = pliant::render::merged(options.camera, file.camera);
  Scene& scene = file.scene;
  for (const int frame : options.strip) require_frame(scene, options.scene, frame);
  if (options.frame) require_frame(scene, options.scene, *options.frame);
  scene.frames = options.frame.value_or(scene.frames);
  make_folder_of(options.out);
  if (is_movie(options)) {
    draw_movie(options, scene, size);
  } else if (!options.strip.empty()) {
    draw_strip(options, scene, size);
  } else {
    draw_picture(options, scene, size);
  }
}

/// Draws the frames of a .glb file.
void draw_glb(const RenderOptions& options, const Size& size) {
  const render::GlbFile file(options.scene);
  const auto require_in_file = [&](int frame) {
    if (frame > file.last_frame())
      throw Error({.file = options.scene}, "has no frame " + std::to_string(frame),
                  "its last one is " + std::to_string(file.last_frame()));
  };
  const int last = options.frame.value_or(file.last_frame());
  std::vector<int> frames = options.strip;
  if (frames.empty()) frames = {last};
  std::for_each(frames.begin(), frames.end(), require_in_file);
  make_folder_of(options.out);
  std::vector<RenderScene> some;
  if (!is_movie(options)) {
    for (const int frame : frames) some.push_back(file.frame(frame));
    return SideBySide(options, size, frames.size()).draw(std::move(some));
  }
  Movie movie(options, size, file.frame_time());
  const int step = std::max(1, last / 24);
  for (int frame = 0; frame <= last; ++frame)
    if (is_in_movie(frame, step, last)) some.push_back(file.frame(frame));
  movie.see(some);
  for (int frame = 0; frame <= last; ++frame) {
    throw_if_interrupted();
    if (is_in_movie(frame, movie.every(), last)) movie.add(file.frame(frame));
  }
  movie.finish();
}

/// Refuses options that change what is simulated, where the pictures are in a file already.
void refuse_changes_of_glb(const RenderOptions& options) {
  const Overrides& given = options.overrides;
  const bool is_changed = given.substeps || given.iterations || !given.sweep.empty() || !given.meshes.empty() ||
                          !given.values.empty();  // threads and the like change no picture
  if (!is_changed) return;
  throw Error({.file = options.scene}, "is drawn as it is: nothing is simulated that options could change",
              "leave out --set, --mesh, --substeps, --iterations and --sweep, or give the scene");
}

void check_render(const RenderOptions& options) {
  if (!is_movie(options) && !has_suffix(options.out, ".png")) {
    Location where;
    where.file = options.out;
    throw Error(where, "is neither .png nor .mp4", "give --out one of these suffixes; for geometry use pliant run");
  }
  if (!options.strip.empty() && (is_movie(options) || options.frame)) {
    throw Error({},
                std::string("--strip draws ") +
                    (is_movie(options) ? "a picture, not a movie" : "several frames, so it excludes --frame"),
                "give --out a name that ends in .png, and the frames to --strip alone");
  }
  if (!options.resume.empty() && (is_movie(options) || !options.strip.empty()))
    throw Error({}, "--resume draws one picture", "give --out a name that ends in .png, and no --strip");
  if (!options.resume.empty() && is_glb(options))
    throw Error({}, "--resume goes on with a scene, and " + options.scene + " is none",
                "give the scene, or no --resume");
  if (is_glb(options)) refuse_changes_of_glb(options);
  refuse_same_file_twice({options.scene, options.resume}, {options.out});
  refuse_unwritable(options.out);
}

}  // namespace

int render(const RenderOptions& options) {
  check_render(options);
  const Size size = parse_size(!options.size.empty() ? options.size : options.draft ? "640x360" : "1280x720");
  if (is_glb(options)) {
    draw_glb(options, size);
  } else {
    draw_scene(options, size);
  }
  if (!options.quiet) print("wrote " + one_line(options.out) + "\n");
  return 0;
}

}  // namespace pliant::command
