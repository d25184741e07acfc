// The passes that draw liquids: their shadows, how much of them each ray passes, and their surfaces.
#include <algorithm>

#include "passes.h"

namespace pliant::render {

namespace {

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

/// Draws what sunlight passes of liquids.
void Renderer::Implementation::draw_liquid_shadows(const Sun& sun, float size) const {
  glBindFramebuffer(GL_FRAMEBUFFER, liquid_shadow.framebuffer.get());
  glViewport(0, 0, liquid_shadow_size, liquid_shadow_size);
  begin_sums();
  glActiveTexture(GL_TEXTURE2);
  glBindTexture(GL_TEXTURE_2D, shadow.texture.get());
  glBindSampler(2, plain_sampler.get());
  const Program& program = programs.liquid_shadow;
  program.use();
  program.set("view_projection", sun.clip);
  program.set("opaque", 2);
  program.set("depth", sun.depth);
  program.set("texels", static_cast<float>(liquid_shadow_size));
  for (const Range& range : ranges) {
    if (range.material != Material::liquid) continue;
    const Vec3f absorption = Vec3f{1.9f, 1.9f, 1.9f} - range.colour * 1.3f;
    program.set("absorption", absorption * (1 / clarity_of(range, size)));
    draw_range(range);
  }
  glBindSampler(2, 0);
  end_sums();
}

bool Renderer::Implementation::has_liquid() const {
  return std::any_of(ranges.begin(), ranges.end(), [](const Range& range) { return range.material == Material::liquid; });
}

/// Adds the distances of one liquid's faces. `middle` is the distance of the scene.
void Renderer::Implementation::draw_thickness(const Eye& eye, const Range& range, float middle) const {
  glBindFramebuffer(GL_FRAMEBUFFER, thickness.framebuffer.get());
  begin_sums();
  const Program& program = programs.thickness;
  program.use();
  program.set("view_projection", eye.view_projection);
  program.set("eye", eye.camera.eye);
  program.set("forward", -eye.frame.back);
  program.set("near_far", eye.near, eye.far);
  program.set("picture", static_cast<float>(width), static_cast<float>(height));
  program.set("middle", middle);
  program.set("depth", 0);
  draw_range(range);
  end_sums();
}

/// Draws each liquid over the picture so far.
void Renderer::Implementation::draw_liquids(const Eye& eye, const Sun& sun, const Extent& extent) const {
  if (!has_liquid()) return;
  const float middle = length(extent.centre - eye.camera.eye);
  glBindSampler(2, 0);
  for (const Range& range : ranges) {
    if (range.material != Material::liquid) continue;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, sampled.framebuffer.get());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, behind.framebuffer.get());
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindVertexArray(array.get());
    const Target* const read[3] = {&depth, &thickness, &behind};
    for (GLuint unit = 0; unit < 3; ++unit) {
      glActiveTexture(GL_TEXTURE0 + unit);
      glBindTexture(GL_TEXTURE_2D, read[unit]->texture.get());
    }
    draw_thickness(eye, range, middle);
    glBindFramebuffer(GL_FRAMEBUFFER, sampled.framebuffer.get());
    const Program& program = programs.liquid;
    program.use();
    program.set("view_projection", eye.view_projection);
    program.set("eye", eye.camera.eye);
    program.set("sun", sun.direction);
    program.set("right", eye.frame.right);
    program.set("up", eye.frame.up);
    program.set("forward", -eye.frame.back);
    program.set("slope", eye.half_width, eye.half_height);
    program.set("near_far", eye.near, eye.far);
    program.set("picture", static_cast<float>(width), static_cast<float>(height));
    program.set("albedo", range.colour);
    program.set("clarity", clarity_of(range, extent.radius));
    program.set("depth", 0);
    program.set("thickness", 1);
    program.set("behind", 2);
    draw_range(range);
  }
}

}  // namespace pliant::render
