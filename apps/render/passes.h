// The passes of a picture, and the OpenGL objects that they use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "context.h"
#include "eye_and_sun.h"
#include "geometry.h"
#include "gl_objects.h"
#include "matrix.h"
#include "render.h"
#include "shaders.h"

namespace pliant::render {

inline constexpr int shadow_size = 2048, liquid_shadow_size = 1024;

/// Where a Geometry is in the vertex and index buffers.
struct Range {
  GLsizei count = 0;
  std::size_t first = 0;  // offset in the index buffer [bytes]
  Vec3f colour{};
  Material material = Material::solid;
  float clarity = 0;            // of a liquid [m]
  std::size_t first_place = 0;  // offset in the buffer of places [bytes]
  GLsizei places = 0;
};

struct Programs {
  Program depth{depth_vertex, depth_fragment};
  Program occlusion{screen_vertex, occlusion_fragment};
  Program blur{screen_vertex, blur_fragment};
  Program sky{screen_vertex, std::string(light_functions) + sky_fragment};
  Program surface{surface_vertex, std::string(light_functions) + surface_fragment};
  Program liquid_shadow{depth_vertex, liquid_shadow_fragment};
  Program thickness{depth_vertex, thickness_fragment};
  Program liquid{surface_vertex, std::string(light_functions) + liquid_fragment};
};

/// A texture, and the framebuffer that draws into it.
struct Target {
  Texture texture;
  Framebuffer framebuffer;
};

/// Over fifteen members: the OpenGL objects that the passes of a picture use.
struct Renderer::Implementation {
  Implementation(int w, int h);
  std::vector<std::uint8_t> draw(const RenderScene& scene);

  void upload(const std::vector<Geometry>& geometries);
  void draw_range(const Range& range) const;
  void draw_ranges(bool ground) const;
  void draw_shadows(const Matrix& clip) const;
  void draw_liquid_shadows(const Sun& sun, float size) const;
  void draw_depth(const Eye& eye) const;
  void draw_occlusion(const Eye& eye, float reach) const;
  void draw_sky(const Eye& eye) const;
  void draw_surfaces(const Eye& eye, const Sun& sun, const Extent& extent, float pixel) const;
  void draw_both_sides(const Range& range) const;
  bool has_liquid() const;
  void draw_thickness(const Eye& eye, const Range& range, float middle) const;
  void draw_liquids(const Eye& eye, const Sun& sun, const Extent& extent) const;
  std::vector<std::uint8_t> read_back() const;
  std::vector<float> read_depths() const;

  int width, height, half_width, half_height;
  Context context;
  Programs programs;
  VertexArray array, nothing;
  Sampler plain_sampler;  // reads depths of the shadow map without comparing them
  Buffer vertices, indices, places;
  Target shadow, depth, raw_occlusion, occlusion, picture, behind, thickness, liquid_shadow;
  SampledTarget sampled;
  std::vector<Range> ranges;
};

}  // namespace pliant::render
