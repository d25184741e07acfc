// The vertex and fragment shaders in GLSL.
#pragma once

namespace pliant::render {

/// Grains of sand share a mesh, but each copy is turned, and has a size and a tone of its own, by its number.
inline constexpr const char* copy_functions = R"(#version 330 core
uniform float uneven;  // 1 for grains, 0 for all else
float random(uint seed) {  // 0 to 1 (O'Neill 2014, PCG)
  uint state = (uint(gl_InstanceID) * 4u + seed) * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return float((word >> 22u) ^ word) / 4294967295.0;
}
vec2 turned(vec2 v, float angle) {
  return vec2(cos(angle) * v.x - sin(angle) * v.y, sin(angle) * v.x + cos(angle) * v.y);
}
vec3 turned_copy(vec3 v) {
  if (uneven == 0.0) return v;
  v.xz = turned(v.xz, 6.2831853 * random(0u));
  v.xy = turned(v.xy, 6.2831853 * random(1u));
  return v;
}
float size_of_copy() { return uneven == 0.0 ? 1.0 : 0.86 + 0.16 * random(2u); }
float tone_of_copy() { return uneven == 0.0 ? 1.0 : 0.62 + 0.6 * random(3u); }
)";

/// Vertex shader with positions only, for the shadow map and the depth pass; after copy_functions.
inline constexpr const char* depth_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 2) in vec4 place;
uniform mat4 view_projection;
out vec3 at;
void main() {
  at = turned_copy(position) * size_of_copy() * place.w + place.xyz;
  gl_Position = view_projection * vec4(at, 1.0);
}
)";

inline constexpr const char* depth_fragment = R"(#version 330 core
void main() {}
)";

/// Vertex shader of a triangle that covers the whole picture.
inline constexpr const char* screen_vertex = R"(#version 330 core
out vec2 place;
void main() {
  place = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  gl_Position = vec4(place * 2.0 - 1.0, 1.0, 1.0);
}
)";

/// Ambient occlusion, from depths alone: points near a pixel that are above its surface hide part of the sky, in
/// proportion to their elevation (McGuire et al. 2011, "The Alchemy screen-space ambient obscurance algorithm"). The
/// sixteen directions are rotated from pixel to pixel in a 4 x 4 pattern, over which the blur averages exactly.
inline constexpr const char* occlusion_fragment = R"(#version 330 core
in vec2 place;
out float openness;
uniform sampler2D depth;
uniform vec2 slope;        // half the picture's extent at distance 1
uniform vec2 near_far;
uniform vec2 texel;
uniform float reach;       // distance within which points hide sky [m]
vec3 seen(vec2 near_by) {
  // Depths are exact only at the centres of pixels.
  vec2 size = vec2(textureSize(depth, 0)), at = (floor(near_by * size) + 0.5) / size;
  float d = texture(depth, at).r * 2.0 - 1.0;
  float distance = 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - d * (near_far.y - near_far.x));
  return vec3((at * 2.0 - 1.0) * slope * distance, -distance);
}
vec3 smaller(vec3 a, vec3 b) { return abs(a.z) < abs(b.z) ? a : b; }
void main() {
  vec3 here = seen(place);
  if (texture(depth, place).r >= 1.0) { openness = 1.0; return; }
  vec3 across = smaller(seen(place + vec2(texel.x, 0.0)) - here, here - seen(place - vec2(texel.x, 0.0)));
  vec3 upward = smaller(seen(place + vec2(0.0, texel.y)) - here, here - seen(place - vec2(0.0, texel.y)));
  vec3 normal = normalize(cross(across, upward));
  ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
  float turn = float(cell.x * 4 + cell.y) * 6.2831853 / 16.0;
  float hidden = 0.0;
  for (int i = 0; i < 16; ++i) {
    float share = (float(i) + 0.5) / 16.0, angle = turn + float(i) * 2.3999632;
    vec2 shift = vec2(cos(angle), sin(angle)) * share * reach / (-here.z) / slope * 0.5;
    vec3 way = seen(place + shift) - here;
    float rise = max(0.0, dot(way, normal) + 0.0015 * here.z);
    hidden += rise / (dot(way, way) + 0.0004 * reach * reach) * smoothstep(2.0 * reach, 0.5 * reach, length(way));
  }
  openness = 0.2 + 0.8 * pow(max(0.0, 1.0 - hidden * reach * 0.15), 1.5);
}
)";

/// The mean over 4 x 4 pixels of similar depth.
inline constexpr const char* blur_fragment = R"(#version 330 core
in vec2 place;
out float openness;
uniform sampler2D occlusion, depth;
uniform vec2 texel, near_far;
float distance_at(vec2 at) {
  float d = texture(depth, at).r * 2.0 - 1.0;
  return 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - d * (near_far.y - near_far.x));
}
void main() {
  float here = distance_at(place), sum = 0.0, weights = 0.0;
  for (int y = -2; y < 2; ++y) {
    for (int x = -2; x < 2; ++x) {
      vec2 at = place + (vec2(x, y) + 0.5) * texel;
      float weight = max(1e-3, 1.0 - 40.0 * abs(distance_at(at) / here - 1.0));
      sum += weight * texture(occlusion, at).r;
      weights += weight;
    }
  }
  openness = sum / weights;
}
)";

/// Colours of the sky, and tone mapping by Narkowicz's fit (2015) of the ACES filmic tone scale; used for sky and
/// surfaces.
inline constexpr const char* light_functions = R"(#version 330 core
uniform vec3 eye;
vec3 sky(vec3 direction) {
  float height = clamp(direction.y, 0.0, 1.0);
  return mix(vec3(1.60, 1.63, 1.66), vec3(0.46, 0.66, 0.96), pow(height, 0.55));
}
vec3 developed(vec3 light) {
  vec3 x = light * 0.47;
  x = clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
}
)";

inline constexpr const char* sky_fragment = R"(
in vec2 place;
out vec4 colour;
uniform vec3 right, up, forward;
uniform vec2 slope;
void main() {
  vec2 at = (place * 2.0 - 1.0) * slope;
  colour = vec4(developed(sky(normalize(forward + at.x * right + at.y * up))), 1.0);
}
)";

/// After copy_functions.
inline constexpr const char* surface_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 place;
layout(location = 3) in float brightness;
layout(location = 4) in vec2 place_in_checks;
uniform mat4 view_projection;
// At the edge of a triangle the centre of a pixel may lie outside of it, where position and normal are wrong.
centroid out vec3 at, facing;
centroid out float shade;
centroid out vec2 checks;
void main() {
  at = turned_copy(position) * size_of_copy() * place.w + place.xyz;
  facing = turned_copy(normal);
  shade = brightness * tone_of_copy();
  checks = place_in_checks;
  gl_Position = view_projection * vec4(at, 1.0);
}
)";

/// Shades cloth, solids and ground: sunlight with soft shadows, light from the sky (blue from above), and for cloth a
/// sheen at grazing angles and some translucency.
inline constexpr const char* surface_fragment = R"(
centroid in vec3 at, facing;
centroid in float shade;
centroid in vec2 checks;
out vec4 colour;
uniform vec3 albedo, sun, centre;
uniform float checked;     // 1 if the cloth has a pattern
uniform int material;      // 0 cloth, 1 solid, 2 ground, 3 grains
uniform mat4 light;        // transform from the world into the shadow map, 0..1
uniform sampler2DShadow shadow;
uniform sampler2D shadow_depth;
uniform sampler2D occlusion;
uniform vec2 picture;      // width and height of the picture in pixels
uniform vec2 spiral[16];   // points evenly distributed over the unit disc
uniform sampler2D liquid_shadow;   // length of the way in liquid [m], and absorption along it
uniform float in_liquid;   // 1 if there is liquid
uniform float widest, softness;  // largest blur of shadows [texels]; its growth with depth
uniform float bias, radius, spacing;
uniform float pixel;       // angle that a pixel takes up
/// Where the shadow of a point is looked up. Ground that is visible in a part of a pixel alone is nearer to the eye
/// than the centre of the pixel, which may be beneath what stands there.
vec3 off_surface(vec3 normal) {
  if (material != 2) return at + normal * bias;
  vec3 view = eye - at;
  vec2 level = view.xz / max(length(view.xz), 1e-6);
  float shift = pixel * dot(view, view) / max(abs(view.y), 0.1 * length(view));
  return at + normal * bias + vec3(level.x, 0.0, level.y) * shift;
}
float lit(vec3 normal) {
  vec3 place = (light * vec4(off_surface(normal), 1.0)).xyz;
  // Outside the shadow map the loop does nothing; in software rendering a branch would save no time.
  int probes = any(greaterThan(abs(place - 0.5), vec3(0.5))) ? 0 : 10;
  float gap = 0.0, found = 0.0, texels = float(textureSize(shadow_depth, 0).x);
  for (int i = 0; i < probes; ++i) {
    float blocker = texelFetch(shadow_depth, ivec2(place.xy * texels + spiral[i] * 1.26 * widest), 0).r;
    float covers = step(blocker, place.z - 0.0005);
    gap += (place.z - blocker) * covers;
    found += covers;
  }
  // A shadow that is narrower than the probes are apart, as that of a rod.
  if (found == 0.0 && probes > 0) found = 0.5 * (1.0 - texture(shadow, vec3(place.xy, place.z - 0.0005)));
  // Shadows get softer with the distance of the object that casts them (Fernando 2005).
  float wide = clamp(gap / max(found, 1.0) * softness, 1.2, widest) / texels;
  int taps = found > 0.0 && found < 9.5 ? 16 : 0;
  float sum = 0.0;
  for (int i = 0; i < taps; ++i) sum += texture(shadow, vec3(place.xy + spiral[i] * wide, place.z));
  return taps > 0 ? sum / 16.0 : float(found == 0.0);
}
/// The share of the sunlight that liquids leave: absorbed by the length of its way, and some turned away by their
/// surfaces.
vec3 left_by_liquid() {
  if (in_liquid == 0.0) return vec3(1.0);
  vec2 place = (light * vec4(at, 1.0)).xy;
  vec4 passed = vec4(0.0);
  for (int i = 0; i < 8; ++i) passed += texture(liquid_shadow, place + spiral[2 * i] * 2.5 / 1024.0) * 0.125;
  passed = max(passed, vec4(0.0));
  return exp(-passed.rgb) * mix(0.75, 1.0, exp(-passed.a / (0.02 * radius)));
}
float lines(float x) {
  float width = fwidth(x);
  float away = abs(fract(x + 0.5) - 0.5) / max(width, 1e-6);
  return clamp(1.2 - away, 0.0, 1.0) * clamp(1.0 - width * 6.0, 0.0, 1.0);
}
/// The share of a pixel that stripes cover, a fifth of the cloth, in one direction.
float stripes(float x) {
  float width = max(fwidth(x), 1e-4), away = abs(fract(x) - 0.5);
  return mix(clamp((0.1 - away) / width + 0.5, 0.0, 1.0), 0.2, clamp(2.0 * width - 0.5, 0.0, 1.0));
}
void main() {
  vec3 normal = normalize(facing), view = normalize(eye - at);
  float open = texture(occlusion, gl_FragCoord.xy / picture).r;
  vec3 base = albedo * shade;
  bool back = material == 0 && !gl_FrontFacing;
  if (checked > 0.0) base *= 1.0 - 0.22 * 0.5 * (stripes(checks.x) + stripes(checks.y));
  if (back) {
    normal = -normal;
    base = mix(base, vec3(dot(base, vec3(0.3, 0.5, 0.2))), 0.12) * 0.72;
  }
  float toward = dot(normal, sun), across = max(dot(normal, view), 0.0);
  float seen = lit(toward < 0.0 && material == 0 ? -normal : normal);
  // Where light grazes, a surface's shadow on itself would show the triangles of the mesh, so direct light fades there.
  float direct = max(toward, 0.0) * smoothstep(0.0, 0.3, toward);
  vec3 sunlight = vec3(1.90, 1.80, 1.62) * left_by_liquid();
  vec3 above = vec3(0.32, 0.365, 0.44), below = vec3(0.19, 0.175, 0.16);
  vec3 around = mix(below, above, normal.y * 0.5 + 0.5) * open;
  vec3 fill = vec3(0.10, 0.105, 0.12) * max(dot(normal, normalize(vec3(-sun.x, 0.25, -sun.z) + 0.6 * view)), 0.0) * open;
  vec3 result = base * (sunlight * direct * seen * mix(0.75, 1.0, open) + around + fill);
  vec3 half_way = normalize(sun + view);
  if (material == 0) {
    result += base * sunlight * 0.16 * max(-toward, 0.0) * smoothstep(0.0, 0.3, -toward) * seen;
    float graze = pow(1.0 - across, 4.0);
    result += (0.35 * base + 0.06) * graze * (above * open + sunlight * direct * seen * 0.4);
    result += sunlight * 0.020 * pow(max(dot(normal, half_way), 0.0), 14.0) * seen;
  } else if (material == 1) {
    float graze = pow(1.0 - across, 5.0);
    result += sunlight * 0.10 * pow(max(dot(normal, half_way), 0.0), 60.0) * seen * max(toward, 0.0);
    result += (0.03 + 0.25 * graze) * sky(reflect(-view, normal)) * open * 0.45;
  } else if (material == 2) {
    float grid = max(lines(at.x / spacing), lines(at.z / spacing));
    result *= 1.0 - 0.13 * grid;
    float away = length(at.xz - centre.xz) / radius;
    result = mix(result, sky(normalize(at - eye)), smoothstep(2.5, 13.0, away));
  }
  colour = vec4(developed(result), 1.0);
}
)";

}  // namespace pliant::render
