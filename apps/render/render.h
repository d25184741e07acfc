// Rendering without a window: what to draw, as plain data; the renderer that draws it; files of pictures and movies.
//
// RenderScene depends on neither World nor OpenGL, so a picture can be tested with a mesh made by hand, and a viewer
// could draw the same data. The Renderer owns an OpenGL 3.3 context made through EGL, which needs neither a window
// system nor a graphics card (Mesa can render in software).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera.h"
#include "pliant/scene.h"
#include "pliant/vec3.h"
#include "pliant/world.h"

namespace pliant::render {

/// A surface with two sides; its back is slightly less bright than its front.
struct RenderMesh {
  std::vector<Vec3f> positions;  ///< positions of the vertices [m]
  std::vector<std::array<int, 3>> triangles;
  Vec3f colour{0.75f, 0.35f, 0.30f};  ///< colour as linear RGB, 0..1
  bool is_solid = false;              ///< true: a collider, drawn with sharp edges
  bool is_liquid = false;        ///< true: the closed surface of a liquid, drawn clear, deeper in colour where thick
  float clarity = 0;             ///< of a liquid, as Fluid::clarity; of another closed surface, as Object::clarity [m]
  std::vector<float> wetness{};  ///< of each vertex, 0 dry to 1 full of liquid, which darkens it; empty: dry
  std::vector<std::array<float, 2>> checks{};  ///< of each vertex: place in a pattern of checks; empty: plain
  std::vector<Vec3f> creased{};  ///< positions in which sharp edges are those of the shape; empty: none is sharp
};

/// A line drawn as a round tube, for ropes; a single point becomes a ball.
struct RenderTube {
  std::vector<Vec3f> points;
  float radius = 0.005f;  ///< radius of the tube [m]; it is drawn at least about a pixel wide
  Vec3f colour{0.75f, 0.35f, 0.30f};
  std::vector<float> radii{};  ///< of each point, if the tube tapers [m]; empty: `radius`
  bool may_stray = false;      ///< true: the camera may leave it out where it is far from the others
};

/// Balls of one radius and colour, for particles. All share one mesh on the graphics card.
struct RenderBalls {
  std::vector<Vec3f> centres;
  float radius = 0.005f;  ///< [m]
  Vec3f colour{0.75f, 0.35f, 0.30f};
  bool are_grains = false;  ///< true: drawn as matt, uneven stones of various tones
};

/// Puffs of smoke, drawn as one volume with self-shadow.
struct RenderSmoke {
  std::vector<Vec3f> centres;
  std::vector<float> strengths;  ///< of each puff: factor of its density, 0..1
  float radius = 0.05f;          ///< [m]
  float opacity = 0.5f;          ///< how much of the light through the middle of a puff of strength 1 it takes
  Vec3f colour{0.8f, 0.8f, 0.8f};
};

/// A rigid body in its present pose. Bodies of equal solids share their mesh.
struct RenderBody {
  std::shared_ptr<const TriangleMesh> mesh;  ///< in the body's principal axes, about its centre of mass
  RigidPose pose{};
  Vec3f colour{0.75f, 0.35f, 0.30f};
  bool is_fixed = false;  ///< true: shown, but framed by the camera only if it is not much larger than what moves
};

/// A collider in its present pose. A horizontal plane is drawn as the ground, a tilted one as a slab.
struct RenderCollider {
  Shape shape = Plane{};
  Vec3f position{};
  Quatf rotation{};
  Vec3f colour{0.45f, 0.48f, 0.52f};
};

/// The size of what pictures show. It determines the size and grid of the ground, the depth range and the width of
/// shadows, so it must be the same in all frames of a movie.
struct Extent {
  Vec3f centre{};
  float radius = 1;  ///< radius of the sphere around the bounding box [m]
};

/// All that a picture shows.
struct RenderScene {
  std::vector<RenderMesh> meshes;
  std::vector<RenderTube> tubes;
  std::vector<RenderCollider> colliders;
  std::optional<float> ground = 0.f;  ///< height of the ground [m]; none: no ground
  std::optional<Camera> camera;       ///< none: a camera that shows the whole scene
  std::optional<Extent> extent;       ///< none: the extent of this scene
  std::vector<RenderBody> bodies{};
  std::vector<RenderBalls> balls{};
  std::vector<RenderSmoke> smokes{};
  std::vector<Vec3f> unseen{};  ///< points that the camera frames, though nothing is drawn there
};

/// Makes what to draw of a World at present: objects with triangles as surfaces, ropes as tubes, free particles as
/// balls, rigid bodies as their solids, tracers as smoke. Gases are not seen.
RenderScene make_render_scene(const Scene& scene, const World& world);

/// A camera that shows every scene in `scenes` in a picture of this shape. Of liquids, free particles and bodies the
/// few that lie far from the others (2.5 % on each side at most) may be outside. For a movie, give scenes between which
/// the motion takes place (at least the first one), and keep the camera.
Camera frame_camera(const std::vector<RenderScene>& scenes, int width, int height, const SceneCamera& options = {});

/// The extent of all scenes together. For a movie, give the same scenes as to frame_camera, and keep the extent.
Extent extent_of(const std::vector<RenderScene>& scenes);

/// How carefully pictures are drawn. A draft has coarser shadows and edges, in less than half of the time.
enum class Quality { full, draft };

/// Draws pictures of one size. Use it from one thread at a time.
class Renderer {
 public:
  /// Makes the OpenGL context. Throws an Error for sizes outside 16..8192, and one that names the Debian package to
  /// install if EGL or OpenGL 3.3 is not available.
  Renderer(int width, int height, Quality quality = Quality::full);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws a picture, and returns its rows from the top: 3 * width * height bytes in sRGB. The same scene gives the
  /// same bytes on the same machine and driver. Throws an Error if a mesh has an index out of range.
  std::vector<std::uint8_t> draw(const RenderScene& scene);

  int width() const;
  int height() const;
  /// The name that the driver gives the device that draws.
  std::string device() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

/// Writes a picture that draw() returned. The file appears when it is complete. If it cannot be written, the Error
/// names the path.
void write_png(const std::string& path, int width, int height, const std::vector<std::uint8_t>& rgb);

/// Writes an .mp4 movie (H.264), which the program ffmpeg encodes frame by frame.
class MovieWriter {
 public:
  /// Starts ffmpeg. Throws an Error if ffmpeg (Debian package ffmpeg) is missing or the file cannot be written.
  /// `frames_per_second` is 1..240.
  MovieWriter(std::string path, int width, int height, double frames_per_second);
  /// Discards the movie unless finish() has succeeded.
  ~MovieWriter();
  MovieWriter(MovieWriter&&) noexcept;
  MovieWriter& operator=(MovieWriter&&) noexcept;

  /// Adds a picture that draw() returned. If ffmpeg failed, throws an Error with its message.
  void add(const std::vector<std::uint8_t>& rgb);
  /// Waits for ffmpeg, and gives the complete file its name.
  void finish();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace pliant::render
