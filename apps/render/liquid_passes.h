// The passes that draw liquids and jelly: their shadows, how much of them each ray passes, and their surfaces.
#pragma once

#include <string>

#include "clear_shaders.h"
#include "eye_and_sun.h"
#include "gl_objects.h"
#include "scene_buffers.h"
#include "shaders.h"

namespace pliant::render {

/// What the passes of liquids read of those before them.
struct OpaquePicture {
  GLuint shadow = 0;         ///< texture: depths that the sun sees
  GLuint plain_sampler = 0;  ///< reads depths without comparing them
  GLuint depth = 0;          ///< texture: depths that the eye sees
  GLuint sampled = 0;        ///< framebuffer: the multisampled picture
};

class LiquidPasses {
 public:
  LiquidPasses(int width, int height);

  /// Draws what sunlight passes of liquids. `size` is that of what the picture shows [m].
  void draw_shadows(const SceneBuffers& scene, const Sun& sun, float size, const OpaquePicture& opaque) const;
  GLuint shadows() const { return shadow_.texture.get(); }
  /// Draws each liquid over the picture so far.
  void draw_surfaces(const SceneBuffers& scene, const Eye& eye, const Sun& sun, const Extent& extent,
                     const OpaquePicture& opaque) const;

 private:
  void draw_entries(const SceneBuffers& scene, const Sun& sun) const;
  void draw_thickness(const SceneBuffers& scene, const Range& range, const Eye& eye, float middle) const;
  void draw_surface(const SceneBuffers& scene, const Range& range, const Eye& eye, const Sun& sun, float size) const;

  int width_, height_;
  Program of_shadows_{std::string(copy_functions) + depth_vertex, liquid_shadow_fragment};
  Program of_thickness_{std::string(copy_functions) + depth_vertex, thickness_fragment};
  Program of_entries_{std::string(copy_functions) + depth_vertex, depth_fragment};
  Program of_surfaces_{std::string(copy_functions) + surface_vertex, std::string(light_functions) + liquid_fragment};
  Program of_jelly_{std::string(copy_functions) + surface_vertex, std::string(light_functions) + jelly_fragment};
  Target shadow_, thickness_, behind_;
  Target entry_;  // depths at which the sun sees jelly
};

}  // namespace pliant::render
