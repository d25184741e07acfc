// Off-screen rendering: a scene's appearance as plain data, the renderer that draws it, and picture and movie files.
//
// RenderScene depends on neither World nor OpenGL, so a picture can be tested with a handmade
// mesh, and a viewer could draw the same description. The Renderer owns an OpenGL 3.3 context made
// through EGL, which needs neither a window system nor a graphics card (Mesa renders in software).
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

/// A two-sided surface; its back is slightly duller than its front.
struct RenderMesh {
  std::vector<Vec3f> positions;  ///< [m]
  std::vector<std::array<int, 3>> triangles;
  Vec3f colour{0.75f, 0.35f, 0.30f};  ///< linear RGB, 0..1
  bool is_solid = false;              ///< a collider, drawn with sharp edges
};

/// A round line, for ropes; a single point is a ball.
struct RenderTube {
  std::vector<Vec3f> points;
  float radius = 0.005f;  ///< [m]; drawn about a pixel wide at least
  Vec3f colour{0.75f, 0.35f, 0.30f};
};

/// A collider in its current pose. A horizontal plane becomes the ground, a tilted one a slab.
struct RenderCollider {
  Shape shape = Plane{};
  Vec3f position{};
  Quatf rotation{};
  Vec3f colour{0.45f, 0.48f, 0.52f};
};

/// The camera of a picture.
struct Camera {
  Vec3f eye{0, 1, 3};
  Vec3f target{};
  float field_of_view = 30;  ///< vertical, 5..120 [degrees]
};

/// Everything to be drawn.
struct RenderScene {
  std::vector<RenderMesh> meshes;
  std::vector<RenderTube> tubes;
  std::vector<RenderCollider> colliders;
  std::optional<float> ground = 0.f;  ///< height of the ground [m]; none: no ground
  std::optional<Camera> camera;       ///< none: frames the whole scene
};

/// The current scene: objects with triangles as surfaces, ropes as tubes, free particles as balls.
RenderScene make_render_scene(const Scene& scene, const World& world);

/// A camera from the front, right and above that shows all of every scene in `scenes`, for a picture of that shape. For a
/// movie, pass the scenes that bound the motion (at least the first) and keep the camera. `azimuth` rotates it about the
/// vertical from the front to the right, `elevation` raises it [degrees].
Camera frame_camera(const std::vector<RenderScene>& scenes, int width, int height, float azimuth = 28,
                    float elevation = 18);

/// Draws pictures of one size. Not thread-safe.
class Renderer {
 public:
  /// Makes the context. Throws an Error that names the Debian package to install
  /// if EGL or OpenGL 3.3 is unavailable, and for sizes outside 16..8192.
  Renderer(int width, int height);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// The picture as rows of sRGB bytes from the top, 3 * width * height in all. The same scene gives the same bytes on the
  /// same machine and driver. Throws an Error if a mesh has an index out of range.
  std::vector<std::uint8_t> draw(const RenderScene& scene);

  int width() const;
  int height() const;
  /// The device that draws, as named by the driver.
  std::string device() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

/// Writes a picture from draw() atomically. An Error names the path.
void write_png(const std::string& path, int width, int height, const std::vector<std::uint8_t>& rgb);

/// An .mp4 (H.264) encoded by the program ffmpeg, frame by frame.
class MovieWriter {
 public:
  /// Throws an Error if ffmpeg (Debian package ffmpeg) is missing or the file cannot be written.
  /// `frames_per_second` 1..240.
  MovieWriter(std::string path, int width, int height, double frames_per_second);
  /// Discards the movie unless finish() has returned.
  ~MovieWriter();
  MovieWriter(MovieWriter&&) noexcept;
  MovieWriter& operator=(MovieWriter&&) noexcept;

  /// Adds a picture from draw(). Throws an Error with ffmpeg's message if it failed.
  void add(const std::vector<std::uint8_t>& rgb);
  /// Waits for ffmpeg and moves the file into place.
  void finish();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace pliant::render
