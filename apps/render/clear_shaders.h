// The shaders of what light passes through, in GLSL: liquids and jelly.
#pragma once

namespace pliant::render {

/// How much liquid a ray passes before it meets what is opaque: the distances at which it leaves the closed surface,
/// less those at which it enters it. Distances are taken from `middle`, so that their sum keeps more digits.
inline constexpr const char* thickness_fragment = R"(#version 330 core
in vec3 at;
out float length_within;
uniform vec3 eye, forward;
uniform sampler2D depth;
uniform vec2 near_far, picture;
uniform float middle;
void main() {
  float d = texture(depth, gl_FragCoord.xy / picture).r * 2.0 - 1.0;
  float opaque = 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - d * (near_far.y - near_far.x));
  float ahead = dot(at - eye, forward), stretch = length(at - eye) / ahead;
  float away = min(ahead, opaque) * stretch - middle;
  length_within = gl_FrontFacing ? -away : away;
}
)";

/// What sunlight passes of a liquid before it meets what is opaque: the length [m] in the fourth component, and its
/// product with the coefficients of absorption in the others.
inline constexpr const char* liquid_shadow_fragment = R"(#version 330 core
out vec4 passed;
uniform sampler2D opaque;
uniform vec3 absorption;
uniform float depth, texels;
void main() {
  float away = min(gl_FragCoord.z, texture(opaque, gl_FragCoord.xy / texels).r) * depth;
  passed = vec4(absorption, 1.0) * (gl_FrontFacing ? -away : away);
}
)";

/// Shades the surface of a liquid: what is behind it, shifted as a refracted ray is (Snell), absorbed by thickness
/// (Beer and Lambert), and the sky's reflection by angle (Schlick 1994).
inline constexpr const char* liquid_fragment = R"(
centroid in vec3 at, facing;
out vec4 colour;
uniform vec3 albedo, sun, right, up, forward;
uniform vec2 picture, slope, near_far;
uniform sampler2D behind, thickness, depth;
uniform float clarity;  // length over which the light of other colours falls to a third [m]
void main() {
  vec3 normal = normalize(facing), view = normalize(eye - at);
  if (dot(normal, view) < 0.0) normal = -normal;
  vec2 place = gl_FragCoord.xy / picture;
  float deep = max(texture(thickness, place).r, 0.0);
  vec3 bend = refract(-view, normal, 1.0 / 1.33) + view;
  vec2 shift = vec2(dot(bend, right), dot(bend, up)) * min(deep, clarity) * 0.5 / (slope * dot(at - eye, forward));
  shift = clamp(shift, vec2(-0.1), vec2(0.1));
  if (texture(depth, place + shift).r < gl_FragCoord.z) shift = vec2(0.0);  // an object before the liquid
  // Of the way that the refracted ray takes: no farther than what it meets.
  float d = texture(depth, place + shift).r * 2.0 - 1.0, ahead = dot(at - eye, forward);
  float opaque = 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - d * (near_far.y - near_far.x));
  deep = clamp((opaque - ahead) * length(at - eye) / ahead, 0.0, max(deep, texture(thickness, place + shift).r));
  vec3 water = developed(albedo * (1.2 + 1.2 * max(dot(normal, sun), 0.0)));  // light that is scattered back
  vec3 seen = texture(behind, place + shift).rgb * exp(-1.3 * (1.0 - albedo) * deep / clarity);
  seen = mix(water, seen, exp(-0.6 * deep / clarity));
  vec3 mirrored = reflect(-view, normal);
  vec3 sky_light = developed(sky(mirrored) * mix(0.35, 1.0, smoothstep(-0.3, 0.1, mirrored.y)));
  // Ripples narrower than a pixel turn grazing light away, so no edge mirrors all of it.
  float reflected = 0.02 + 0.58 * pow(1.0 - max(dot(normal, view), 0.0), 5.0);
  float glint = pow(max(dot(normal, normalize(sun + view)), 0.0), 250.0);
  colour = vec4(mix(seen, sky_light, reflected) + vec3(0.8, 0.78, 0.72) * glint, 1.0);
}
)";

/// Shades jelly: light of the sun and the sky that is scattered within it, along the ray of a pixel. The way that light
/// has taken in it to each place is that from the depth at which the sun sees it; both ways absorb (Beer and Lambert).
inline constexpr const char* jelly_fragment = R"(
centroid in vec3 at, facing;
out vec4 colour;
uniform vec3 albedo, sun, right, up, forward;
uniform vec2 picture, slope, near_far;
uniform sampler2D behind, thickness, depth, entry;
uniform sampler2DShadow shadow;
uniform mat4 light;         // transform from the world into the shadow map, 0..1
uniform float light_depth;  // of the shadow map along the rays [m]
uniform float clarity;      // length over which the light of other colours falls to a third [m]
void main() {
  vec3 normal = normalize(facing), view = normalize(eye - at);
  if (dot(normal, view) < 0.0) normal = -normal;
  vec2 place = gl_FragCoord.xy / picture;
  float d = texture(depth, place).r * 2.0 - 1.0, ahead = dot(at - eye, forward);
  float opaque = 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - d * (near_far.y - near_far.x));
  float deep = clamp((opaque - ahead) * length(at - eye) / ahead, 0.0, max(texture(thickness, place).r, 0.0));
  vec3 absorbed = (1.3 - 1.2 * albedo) / clarity;
  float scattered = 2.0 / clarity;
  vec3 lost = absorbed + scattered;
  vec3 around = mix(vec3(0.22, 0.2, 0.19), vec3(0.42, 0.46, 0.54), normal.y * 0.5 + 0.5);
  vec3 sum = vec3(0.0);
  float step = deep / 8.0;
  for (int i = 0; i < 8; ++i) {
    float way = (float(i) + 0.5) * step;
    vec3 map = (light * vec4(at - view * way, 1.0)).xyz;
    float before = max(map.z - texture(entry, map.xy).r, 0.0) * light_depth;
    float seen = texture(shadow, vec3(map.xy, map.z - 0.001));
    // Light that is scattered forward goes on, so less is lost on the way in.
    vec3 sunlight = vec3(1.90, 1.80, 1.62) * seen * exp(-(absorbed + 0.25 * scattered) * before);
    sum += (sunlight + around) * exp(-(absorbed + 0.5 * scattered) * way) * step;
  }
  // The skin of jelly is less clear, else thin edges could not be seen.
  vec3 through = exp(-(absorbed + 0.5 * scattered) * deep - 0.25);
  // What a layer scatters, over what it does not let through: the colour of a thick one.
  vec3 inner = mix(albedo, vec3(1.0), 0.12) * sum * (absorbed + 0.5 * scattered) / max(1.0 - through, 0.02);
  float toward = max(dot(normal, sun), 0.0);
  vec3 at_light = (light * vec4(at, 1.0)).xyz;
  float lit = texture(shadow, vec3(at_light.xy, at_light.z - 0.001));
  inner += albedo * vec3(1.90, 1.80, 1.62) * 0.25 * toward * lit;
  vec3 seen = mix(developed(inner), texture(behind, place).rgb, through);
  vec3 mirrored = reflect(-view, normal);
  vec3 sky_light = developed(sky(mirrored) * mix(0.35, 0.8, smoothstep(-0.3, 0.1, mirrored.y)));
  float reflected = 0.02 + 0.5 * pow(1.0 - max(dot(normal, view), 0.0), 5.0);
  float glint = 0.35 * pow(max(dot(normal, normalize(sun + view)), 0.0), 90.0) * lit;
  colour = vec4(mix(seen, sky_light, reflected) + vec3(0.8, 0.78, 0.72) * glint, 1.0);
}
)";

}  // namespace pliant::render
