// Pictures without a screen: what a scene looks like as plain data, the renderer that draws it, and the files it goes to.
//
// RenderScene knows neither World nor OpenGL, so that a picture can be tested from a mesh made by hand, and so that a
// viewer could draw the same description. The Renderer owns an OpenGL 3.3 context made through EGL, which needs neither a
// window system nor a graphics card (Mesa draws in software where there is none).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "pliant/vec3.h"
#include "pliant/world.h"

namespace pliant::render {

/// A surface, seen from both sides; its back is a little duller than its front.
struct RenderMesh {
  std::vector<Vec3f> positions;  ///< [m]
  std::vector<std::array<int, 3>> triangles;
  Vec3f colour{0.75f, 0.35f, 0.30f};  ///< linear RGB, 0..1
  bool is_solid = false;              ///< a collider: its sharp edges are drawn sharp
};

/// A round line, for ropes; one point alone is a ball.
struct RenderTube {
  std::vector<Vec3f> points;
  float radius = 0.005f;  ///< [m]; drawn at least about a pixel wide
  Vec3f colour{0.75f, 0.35f, 0.30f};
};

/// A collider where it is now. A level plane becomes the ground, a tilted one a slab.
struct RenderCollider {
  Shape shape = Plane{};
  Vec3f position{};
  Quatf rotation{};
  Vec3f colour{0.45f, 0.48f, 0.52f};
};

/// Where the picture is taken from.
struct Camera {
  Vec3f eye{0, 1, 3};
  Vec3f target{};
  float field_of_view = 30;  ///< vertical, 5..120 [degrees]
};

/// What there is to see.
struct RenderScene {
  std::vector<RenderMesh> meshes;
  std::vector<RenderTube> tubes;
  std::vector<RenderCollider> colliders;
  std::optional<float> ground = 0.f;  ///< height of the ground [m]; none: no ground
  std::optional<Camera> camera;       ///< none: frames everything there is to see
};

/// The scene as it looks now: objects with triangles as surfaces, ropes as tubes, loose particles as balls.
RenderScene make_render_scene(const Scene& scene, const World& world);

/// A camera from the front, right and above that shows all of every scene in `scenes`, in a picture of that shape. For a
/// movie give it the scenes that bound the motion (at least the first) and keep the camera for every frame. `azimuth` turns
/// it about the vertical from the front to the right, `elevation` lifts it [degrees].
Camera frame_camera(const std::vector<RenderScene>& scenes, int width, int height, float azimuth = 28,
                    float elevation = 18);

/// Draws pictures of one size. Not for use by two threads at once.
class Renderer {
 public:
  /// Makes the context. Throws Error, naming the Debian package to install, where EGL or OpenGL 3.3 is not to be had, and
  /// for sizes outside 16..8192.
  Renderer(int width, int height);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// The picture as rows of RGB bytes from the top, 3 * width * height of them, in sRGB. The same scene gives the same
  /// bytes on the same machine and driver. Throws Error where a mesh has an index out of range.
  std::vector<std::uint8_t> draw(const RenderScene& scene);

  int width() const;
  int height() const;
  /// What draws, in the driver's words.
  std::string device() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

/// Writes a picture as draw() gives it. The file is whole or as it was before; Error names the path.
void write_png(const std::string& path, int width, int height, const std::vector<std::uint8_t>& rgb);

/// An .mp4 (H.264) made by the program ffmpeg, frame by frame.
class MovieWriter {
 public:
  /// Throws Error where there is no ffmpeg (Debian package ffmpeg), or the file may not be written.
  /// `frames_per_second` 1..240.
  MovieWriter(std::string path, int width, int height, double frames_per_second);
  /// Drops the movie unless finish() has returned.
  ~MovieWriter();
  MovieWriter(MovieWriter&&) noexcept;
  MovieWriter& operator=(MovieWriter&&) noexcept;

  /// Adds a picture as draw() gives it. Throws Error with ffmpeg's own words where it gave up.
  void add(const std::vector<std::uint8_t>& rgb);
  /// Waits for ffmpeg and puts the file in place.
  void finish();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace pliant::render
