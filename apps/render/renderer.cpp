// Draws a picture in passes: shadow map, shadows of liquids, depth, ambient occlusion, the multisampled picture with
// its liquids, and the mean of its samples.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>

#include "context.h"
#include "eye_and_sun.h"
#include "geometry.h"
#include "gl_objects.h"
#include "liquid_passes.h"
#include "matrix.h"
#include "pliant/error.h"
#include "render.h"
#include "scene_buffers.h"
#include "shaders.h"
#include "smoke.h"

namespace pliant::render {

namespace {

int shadow_map_size_of(Quality quality) { return quality == Quality::draft ? 1024 : 2048; }

/// Points that are evenly distributed over the unit disc: a golden-angle spiral (Vogel 1979).
std::vector<std::pair<float, float>> spiral(int count) {
  std::vector<std::pair<float, float>> places;
  for (int i = 0; i < count; ++i) {
    const float angle = static_cast<float>(i) * 2.3999632f;
    const float radius = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
    places.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return places;
}

int best_samples(Quality quality) {
  GLint most = 4;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  return std::clamp(most, 1, quality == Quality::draft ? 2 : 8);
}

/// The spacing of the ground's grid: a power of ten that shows a few lines.
float grid_spacing(float radius) {
  float spacing = 1;
  while (spacing > 0.5f * radius) spacing /= 10;
  while (spacing * 10 <= 0.5f * radius) spacing *= 10;
  return spacing;
}

}  // namespace

/// Over fifteen members: the OpenGL objects that the passes of a picture use.
struct Renderer::Implementation {
  struct Programs {
    Program depth{std::string(copy_functions) + depth_vertex, depth_fragment};
    Program occlusion{screen_vertex, occlusion_fragment};
    Program blur{screen_vertex, blur_fragment};
    Program sky{screen_vertex, std::string(light_functions) + sky_fragment};
    Program surface{std::string(copy_functions) + surface_vertex, std::string(light_functions) + surface_fragment};
  };

  Implementation(int w, int h, Quality quality);
  std::vector<std::uint8_t> draw(const RenderScene& scene);

  void draw_ranges(bool ground) const;
  void draw_shadows(const Matrix& clip) const;
  void draw_depth(const Eye& eye) const;
  void draw_occlusion(const Eye& eye, float reach) const;
  void draw_sky(const Eye& eye) const;
  void draw_surfaces(const Eye& eye, const Sun& sun, const Extent& extent, float pixel) const;
  void draw_both_sides(const Range& range) const;
  std::vector<std::uint8_t> read_back() const;
  std::vector<float> read_depths() const;
  OpaquePicture opaque() const;

  int width, height, half_width, half_height, shadow_map_size;
  Context context;
  Programs programs;
  SceneBuffers buffers;
  VertexArray nothing;
  Sampler plain_sampler;  // reads depths of the shadow map without comparing them
  Target shadow, depth, raw_occlusion, occlusion, picture;
  SampledTarget sampled;
  LiquidPasses liquids;
};

Renderer::Implementation::Implementation(int w, int h, Quality quality)
    : width(w),
      height(h),
      half_width((w + 1) / 2),
      half_height((h + 1) / 2),
      shadow_map_size(shadow_map_size_of(quality)),
      sampled(w, h, best_samples(quality)),
      liquids(w, h) {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  nothing = VertexArray(name);
  shadow.texture = make_texture(GL_DEPTH_COMPONENT24, shadow_map_size, shadow_map_size, GL_DEPTH_COMPONENT,
                                GL_UNSIGNED_INT, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  GLuint sampler = 0;
  glGenSamplers(1, &sampler);
  plain_sampler = Sampler(sampler);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glSamplerParameteri(sampler, filter, GL_NEAREST);
  glSamplerParameteri(sampler, GL_TEXTURE_COMPARE_MODE, GL_NONE);
  shadow.framebuffer = make_framebuffer(0, shadow.texture.get());
  depth.texture = make_texture(GL_DEPTH_COMPONENT24, width, height, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_NEAREST);
  depth.framebuffer = make_framebuffer(0, depth.texture.get());
  raw_occlusion = colour_target(make_texture(GL_R8, half_width, half_height, GL_RED, GL_UNSIGNED_BYTE, GL_NEAREST));
  occlusion = colour_target(make_texture(GL_R8, half_width, half_height, GL_RED, GL_UNSIGNED_BYTE, GL_LINEAR));
  picture = colour_target(make_texture(GL_RGBA8, width, height, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST));
}

void Renderer::Implementation::draw_ranges(bool ground) const {
  for (const Range& range : buffers.ranges()) {
    if ((range.material == Material::ground && !ground) || is_clear(range.material)) continue;
    programs.depth.set("uneven", range.material == Material::grains ? 1.f : 0.f);
    buffers.draw(range);
  }
}

void Renderer::Implementation::draw_shadows(const Matrix& clip) const {
  glBindFramebuffer(GL_FRAMEBUFFER, shadow.framebuffer.get());
  glViewport(0, 0, shadow_map_size, shadow_map_size);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 2.f);
  programs.depth.use();
  programs.depth.set("view_projection", clip);
  draw_ranges(false);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::Implementation::draw_depth(const Eye& eye) const {
  glBindFramebuffer(GL_FRAMEBUFFER, depth.framebuffer.get());
  glViewport(0, 0, width, height);
  glClear(GL_DEPTH_BUFFER_BIT);
  programs.depth.use();
  programs.depth.set("view_projection", eye.view_projection);
  draw_ranges(true);
}

void Renderer::Implementation::draw_occlusion(const Eye& eye, float reach) const {
  const auto texel_x = 1 / static_cast<float>(half_width), texel_y = 1 / static_cast<float>(half_height);
  glBindVertexArray(nothing.get());
  glDisable(GL_DEPTH_TEST);
  glViewport(0, 0, half_width, half_height);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, depth.texture.get());
  glBindFramebuffer(GL_FRAMEBUFFER, raw_occlusion.framebuffer.get());
  programs.occlusion.use();
  programs.occlusion.set("depth", 0);
  programs.occlusion.set("slope", eye.half_width, eye.half_height);
  programs.occlusion.set("near_far", eye.near, eye.far);
  programs.occlusion.set("texel", texel_x, texel_y);
  programs.occlusion.set("reach", reach);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindFramebuffer(GL_FRAMEBUFFER, occlusion.framebuffer.get());
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, raw_occlusion.texture.get());
  programs.blur.use();
  programs.blur.set("depth", 0);
  programs.blur.set("occlusion", 1);
  programs.blur.set("texel", texel_x, texel_y);
  programs.blur.set("near_far", eye.near, eye.far);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Implementation::draw_sky(const Eye& eye) const {
  glBindVertexArray(nothing.get());
  glDisable(GL_DEPTH_TEST);
  programs.sky.use();
  programs.sky.set("right", eye.frame.right);
  programs.sky.set("up", eye.frame.up);
  programs.sky.set("forward", -eye.frame.back);
  programs.sky.set("slope", eye.half_width, eye.half_height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Implementation::draw_surfaces(const Eye& eye, const Sun& sun, const Extent& extent, float pixel) const {
  buffers.bind();
  glEnable(GL_DEPTH_TEST);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, shadow.texture.get());
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, occlusion.texture.get());
  glActiveTexture(GL_TEXTURE2);
  glBindTexture(GL_TEXTURE_2D, shadow.texture.get());
  glBindSampler(2, plain_sampler.get());
  glActiveTexture(GL_TEXTURE3);
  glBindTexture(GL_TEXTURE_2D, liquids.shadows());
  const Program& program = programs.surface;
  const float size = extent.radius;
  program.use();
  program.set("shadow", 0);
  program.set("shadow_depth", 2);
  program.set("occlusion", 1);
  program.set("liquid_shadow", 3);
  program.set("in_liquid", buffers.has_clear() ? 1.f : 0.f);
  program.set("view_projection", eye.view_projection);
  program.set("light", to_texture(sun.clip));
  program.set("eye", eye.camera.eye);
  program.set("sun", sun.direction);
  program.set("centre", extent.centre);
  program.set("radius", size);
  program.set("spacing", grid_spacing(size));
  program.set("picture", static_cast<float>(width), static_cast<float>(height));
  program.set("widest", 18.f);
  program.set("softness", sun.softness * static_cast<float>(shadow_map_size));
  program.set("spiral", spiral(16));
  program.set("pixel", 2 * eye.half_height / static_cast<float>(height));
  // If the centre of a pixel is outside the triangle that is visible in it, its position is up to a pixel away from the
  // surface.
  program.set("bias", std::max(5 * size / static_cast<float>(shadow_map_size), 2 * pixel));
  for (const Range& range : buffers.ranges()) {
    if (is_clear(range.material)) continue;
    program.set("uneven", range.material == Material::grains ? 1.f : 0.f);
    program.set("albedo", range.colour);
    program.set("checked", range.checked ? 1.f : 0.f);
    program.set("material", static_cast<int>(range.material));
    draw_both_sides(range);
  }
}

/// Draws backs and fronts separately: where two layers of cloth coincide, the front wins, without z-fighting.
void Renderer::Implementation::draw_both_sides(const Range& range) const {
  if (range.material != Material::cloth) return buffers.draw(range);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  buffers.draw(range);
  glCullFace(GL_FRONT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.f, 4.f);
  buffers.draw(range);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CULL_FACE);
}

std::vector<std::uint8_t> Renderer::Implementation::read_back() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, sampled.framebuffer.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, picture.framebuffer.get());
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer.get());
  const std::size_t row = static_cast<std::size_t>(width) * 3, rows = static_cast<std::size_t>(height);
  std::vector<std::uint8_t> upside_down(row * rows), result(row * rows);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
  if (glGetError() != GL_NO_ERROR)
    throw Error({}, "the OpenGL driver failed while drawing", "choose a smaller picture");
  for (std::size_t y = 0; y < rows; ++y) std::memcpy(&result[y * row], &upside_down[(rows - 1 - y) * row], row);
  return result;
}

std::vector<float> Renderer::Implementation::read_depths() const {
  std::vector<float> depths(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, depth.framebuffer.get());
  glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
  if (glGetError() != GL_NO_ERROR)
    throw Error({}, "the OpenGL driver failed while drawing", "choose a smaller picture");
  return depths;
}

OpaquePicture Renderer::Implementation::opaque() const {
  return {shadow.texture.get(), plain_sampler.get(), depth.texture.get(), sampled.framebuffer.get()};
}

std::vector<std::uint8_t> Renderer::Implementation::draw(const RenderScene& scene) {
  check(scene);
  context.make_current();
  const Extent extent = scene.extent ? *scene.extent : extent_of({scene});
  const Camera camera = scene.camera ? *scene.camera : frame_camera({scene}, width, height);
  const Eye eye = make_eye(camera, width, height, extent);
  const float pixel = 2 * eye.half_height * length(camera.eye - extent.centre) / static_cast<float>(height);
  std::vector<Geometry> geometries = build_geometry(scene, extent.centre, extent.radius, 0.9f * pixel, camera.eye);
  const Sun sun = make_sun(eye.frame, geometries, extent);
  if (scene.ground) {
    Vec3f colour{0.60f, 0.60f, 0.59f};
    for (const RenderCollider& c : scene.colliders)
      if (is_level_plane(c) && std::abs(c.position.y - *scene.ground) < 1e-6f) colour = c.colour;
    const Vec3f centre = extent.centre;
    const float sink = 0.0007f * extent.radius;  // keeps objects that lie on the ground visible
    geometries.push_back(build_ground({centre.x, *scene.ground - sink, centre.z}, 30 * extent.radius, colour));
  }
  buffers.upload(geometries);
  glEnable(GL_DEPTH_TEST);
  draw_shadows(sun.clip);
  if (buffers.has_clear()) liquids.draw_shadows(buffers, sun, extent.radius, opaque());
  draw_depth(eye);
  draw_occlusion(eye, 0.08f * extent.radius);
  glBindFramebuffer(GL_FRAMEBUFFER, sampled.framebuffer.get());
  glViewport(0, 0, width, height);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_sky(eye);
  draw_surfaces(eye, sun, extent, pixel);
  liquids.draw_surfaces(buffers, eye, sun, extent, opaque());
  std::vector<std::uint8_t> result = read_back();
  if (scene.smokes.empty()) return result;
  const SmokeView view{.eye = camera.eye,
                       .frame = eye.frame,
                       .half_width = eye.half_width,
                       .half_height = eye.half_height,
                       .near = eye.near,
                       .far = eye.far,
                       .width = width,
                       .height = height,
                       .sun = sun.direction};
  draw_smoke(scene.smokes, view, read_depths(), result);
  return result;
}

Renderer::Renderer(int width, int height, Quality quality) {
  constexpr int smallest = 16, largest = 8192;
  if (width < smallest || height < smallest || width > largest || height > largest)
    throw Error({},
                "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels cannot be drawn",
                "choose 16 to 8192 pixels for width and height");
  self_ = std::make_unique<Implementation>(width, height, quality);
}

Renderer::~Renderer() {
  // OpenGL objects must be deleted while their own context is current.
  if (self_) self_->context.make_current();
}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

std::vector<std::uint8_t> Renderer::draw(const RenderScene& scene) { return self_->draw(scene); }
int Renderer::width() const { return self_->width; }
int Renderer::height() const { return self_->height; }
std::string Renderer::device() const { return self_->context.device(); }

}  // namespace pliant::render
