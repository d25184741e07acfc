#include "liquid_passes.h"

namespace pliant::render {

namespace {

constexpr int liquid_shadow_size = 1024;

/// Makes what is drawn add to what the framebuffer holds, from 0 on.
void begin_sums() {
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
}

void end_sums() {
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
}

/// The clarity of a liquid; `size` is that of what the picture shows [m].
float clarity_of(const Range& range, float size) { return range.clarity > 0 ? range.clarity : 0.6f * size; }

}  // namespace

LiquidPasses::LiquidPasses(int width, int height) : width_(width), height_(height) {
  Texture shadow = make_texture(GL_RGBA32F, liquid_shadow_size, liquid_shadow_size, GL_RGBA, GL_FLOAT, GL_LINEAR);
  for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})  // no liquid outside: the border is zero
    glTexParameteri(GL_TEXTURE_2D, direction, GL_CLAMP_TO_BORDER);
  shadow_ = colour_target(std::move(shadow));
  thickness_ = colour_target(make_texture(GL_R32F, width, height, GL_RED, GL_FLOAT, GL_NEAREST));
  entry_.texture = make_texture(GL_DEPTH_COMPONENT24, liquid_shadow_size, liquid_shadow_size, GL_DEPTH_COMPONENT,
                                GL_UNSIGNED_INT, GL_LINEAR);
  entry_.framebuffer = make_framebuffer(0, entry_.texture.get());
  behind_ = colour_target(make_texture(GL_RGBA8, width, height, GL_RGBA, GL_UNSIGNED_BYTE, GL_LINEAR));
}

void LiquidPasses::draw_shadows(const SceneBuffers& scene, const Sun& sun, float size,
                                const OpaquePicture& opaque) const {
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_.framebuffer.get());
  glViewport(0, 0, liquid_shadow_size, liquid_shadow_size);
  begin_sums();
  glActiveTexture(GL_TEXTURE2);
  glBindTexture(GL_TEXTURE_2D, opaque.shadow);
  glBindSampler(2, opaque.plain_sampler);
  of_shadows_.use();
  of_shadows_.set("view_projection", sun.clip);
  of_shadows_.set("opaque", 2);
  of_shadows_.set("depth", sun.depth);
  of_shadows_.set("texels", static_cast<float>(liquid_shadow_size));
  for (const Range& range : scene.ranges()) {
    if (!is_clear(range.material)) continue;
    const Vec3f absorption = Vec3f{1.9f, 1.9f, 1.9f} - range.colour * 1.3f;
    of_shadows_.set("absorption", absorption * (1 / clarity_of(range, size)));
    scene.draw(range);
  }
  glBindSampler(2, 0);
  end_sums();
  if (scene.has(Material::jelly)) draw_entries(scene, sun);
}

void LiquidPasses::draw_entries(const SceneBuffers& scene, const Sun& sun) const {
  glBindFramebuffer(GL_FRAMEBUFFER, entry_.framebuffer.get());
  glViewport(0, 0, liquid_shadow_size, liquid_shadow_size);
  glClear(GL_DEPTH_BUFFER_BIT);
  of_entries_.use();
  of_entries_.set("view_projection", sun.clip);
  for (const Range& range : scene.ranges())
    if (range.material == Material::jelly) scene.draw(range);
}

/// Adds the distances of one liquid's faces. `middle` is the distance of the scene.
void LiquidPasses::draw_thickness(const SceneBuffers& scene, const Range& range, const Eye& eye, float middle) const {
  glBindFramebuffer(GL_FRAMEBUFFER, thickness_.framebuffer.get());
  begin_sums();
  of_thickness_.use();
  of_thickness_.set("view_projection", eye.view_projection);
  of_thickness_.set("eye", eye.camera.eye);
  of_thickness_.set("forward", -eye.frame.back);
  of_thickness_.set("near_far", eye.near, eye.far);
  of_thickness_.set("picture", static_cast<float>(width_), static_cast<float>(height_));
  of_thickness_.set("middle", middle);
  of_thickness_.set("depth", 0);
  scene.draw(range);
  end_sums();
}

void LiquidPasses::draw_surface(const SceneBuffers& scene, const Range& range, const Eye& eye, const Sun& sun,
                                float size) const {
  const Program& program = range.material == Material::jelly ? of_jelly_ : of_surfaces_;
  program.use();
  program.set("view_projection", eye.view_projection);
  program.set("eye", eye.camera.eye);
  program.set("sun", sun.direction);
  program.set("right", eye.frame.right);
  program.set("up", eye.frame.up);
  program.set("forward", -eye.frame.back);
  program.set("slope", eye.half_width, eye.half_height);
  program.set("near_far", eye.near, eye.far);
  program.set("picture", static_cast<float>(width_), static_cast<float>(height_));
  program.set("albedo", range.colour);
  program.set("clarity", clarity_of(range, size));
  program.set("depth", 0);
  program.set("thickness", 1);
  program.set("behind", 2);
  program.set("entry", 3);
  program.set("shadow", 4);
  program.set("light", to_texture(sun.clip));
  program.set("light_depth", sun.depth);
  scene.draw(range);
}

void LiquidPasses::draw_surfaces(const SceneBuffers& scene, const Eye& eye, const Sun& sun, const Extent& extent,
                                 const OpaquePicture& opaque) const {
  if (!scene.has_clear()) return;
  const float middle = length(extent.centre - eye.camera.eye);
  glBindSampler(2, 0);
  for (const Range& range : scene.ranges()) {
    if (!is_clear(range.material)) continue;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, opaque.sampled);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, behind_.framebuffer.get());
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    scene.bind();
    const GLuint read[5] = {opaque.depth, thickness_.texture.get(), behind_.texture.get(), entry_.texture.get(),
                            opaque.shadow};
    for (GLuint unit = 0; unit < 5; ++unit) {
      glActiveTexture(GL_TEXTURE0 + unit);
      glBindTexture(GL_TEXTURE_2D, read[unit]);
    }
    draw_thickness(scene, range, eye, middle);
    glBindFramebuffer(GL_FRAMEBUFFER, opaque.sampled);
    draw_surface(scene, range, eye, sun, extent.radius);
  }
}

}  // namespace pliant::render
