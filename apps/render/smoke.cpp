#include "smoke.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

#include "geometry.h"

namespace pliant::render {

namespace {

constexpr std::size_t most_cells = 6'000'000;

/// Calls body(i) for 0 <= i < count on all threads.
template <class Body>
void on_all_threads(int count, const Body& body) {
  const int threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16);
  std::vector<std::thread> others;
  const auto work = [&](int thread) {
    for (int i = thread; i < count; i += threads) body(i);
  };
  for (int thread = 1; thread < threads; ++thread) others.emplace_back(work, thread);
  work(0);
  for (std::thread& other : others) other.join();
}

/// A value at the centre of each cell of a regular grid.
struct Grid {
  Vec3f low{};
  float cell = 1;
  std::array<int, 3> size{};
  std::vector<float> values;

  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(z));
  }
  /// The value at a place, linear between cells; zero outside.
  float at(const Vec3f& p) const {
    const float x = (p.x - low.x) / cell - 0.5f, y = (p.y - low.y) / cell - 0.5f, z = (p.z - low.z) / cell - 0.5f;
    if (!(x >= 0 && y >= 0 && z >= 0)) return 0;
    const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
    if (i + 1 >= size[0] || j + 1 >= size[1] || k + 1 >= size[2]) return 0;
    const float u = x - static_cast<float>(i), v = y - static_cast<float>(j), w = z - static_cast<float>(k);
    const float* const corner = &values[index(i, j, k)];
    const std::size_t row = static_cast<std::size_t>(size[0]), layer = row * static_cast<std::size_t>(size[1]);
    const auto along = [&](const float* of) { return of[0] + u * (of[1] - of[0]); };
    const float front = along(corner) + v * (along(corner + row) - along(corner));
    const float back = along(corner + layer) + v * (along(corner + layer + row) - along(corner + layer));
    return front + w * (back - front);
  }
};

/// An empty grid around all puffs.
Grid grid_around(const RenderSmoke& smoke) {
  Bounds box;
  for (const Vec3f& p : smoke.centres) box.include(p, smoke.radius);
  Grid grid;
  grid.cell = smoke.radius / 2;
  const Vec3f extent = box.high - box.low;
  const auto cells = [&](float along) { return static_cast<std::size_t>(along / grid.cell) + 4; };
  while (cells(extent.x) * cells(extent.y) * cells(extent.z) > most_cells) grid.cell *= 1.2f;
  grid.low = box.low - Vec3f{grid.cell, grid.cell, grid.cell};
  grid.size = {static_cast<int>(cells(extent.x)), static_cast<int>(cells(extent.y)), static_cast<int>(cells(extent.z))};
  grid.values.assign(cells(extent.x) * cells(extent.y) * cells(extent.z), 0);
  return grid;
}

/// Adds a puff: (1 - r^2 / R^2)^2 times `middle` [1/m].
void add_puff(Grid& grid, const Vec3f& centre, float radius, float middle) {
  const float reach = std::max(radius, grid.cell), thinned = radius / reach;
  middle *= thinned * thinned * thinned;  // a puff wider than it is has as much smoke
  std::array<int, 3> first{}, last{};
  const std::array<float, 3> at{centre.x - grid.low.x, centre.y - grid.low.y, centre.z - grid.low.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = std::max(static_cast<int>((at[axis] - reach) / grid.cell), 0);
    last[axis] = std::min(static_cast<int>((at[axis] + reach) / grid.cell), grid.size[axis] - 1);
  }
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x) {
        const auto apart = [&](int cell, float from) { return (static_cast<float>(cell) + 0.5f) * grid.cell - from; };
        const Vec3f d{apart(x, at[0]), apart(y, at[1]), apart(z, at[2])};
        const float share = 1 - length_squared(d) / (reach * reach);
        if (share > 0) grid.values[grid.index(x, y, z)] += middle * share * share;
      }
}

Grid extinction_of(const RenderSmoke& smoke) {
  Grid grid = grid_around(smoke);
  // Along a diameter the puff's profile sums to 16/15 of the radius.
  const float middle = -std::log(1 - std::min(smoke.opacity, 0.999f)) / (16.f / 15 * smoke.radius);
  for (std::size_t i = 0; i < smoke.centres.size(); ++i)
    add_puff(grid, smoke.centres[i], smoke.radius, middle * smoke.strengths[i]);
  return grid;
}

/// How much of the sun's light reaches each cell.
Grid light_in(const Grid& extinction, const Vec3f& sun) {
  constexpr float step = 1.5f;  // cells
  Grid light = extinction;
  on_all_threads(extinction.size[2], [&](int z) {
    for (int y = 0; y < extinction.size[1]; ++y)
      for (int x = 0; x < extinction.size[0]; ++x) {
        const auto middle = [&](int cell) { return (static_cast<float>(cell) + 0.5f) * extinction.cell; };
        Vec3f p = extinction.low + Vec3f{middle(x), middle(y), middle(z)};
        const Vec3f way = sun * (step * extinction.cell);
        float depth = 0;
        // Where there is no smoke nearby, nothing asks for the light.
        const bool is_asked = extinction.values[extinction.index(x, y, z)] > 0;
        for (int i = 0; is_asked && i < 200 && depth < 6; ++i) {
          p += way;
          const Vec3f end = p - extinction.low;
          if (end.x < 0 || end.y < 0 || end.z < 0 || end.x > middle(extinction.size[0]) ||
              end.y > middle(extinction.size[1]) || end.z > middle(extinction.size[2]))
            break;
          depth += extinction.at(p) * step * extinction.cell;
        }
        light.values[light.index(x, y, z)] = std::exp(-depth);
      }
  });
  return light;
}

/// The part of a ray that is in a grid.
struct Span {
  float from = 0, to = 0;
};

Span span_in(const Grid& grid, const Vec3f& eye, const Vec3f& way) {
  Span span{0, 1e30f};
  const std::array<float, 3> from{eye.x - grid.low.x, eye.y - grid.low.y, eye.z - grid.low.z},
      along{way.x, way.y, way.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float extent = static_cast<float>(grid.size[axis]) * grid.cell;
    const float inverse = 1 / (std::abs(along[axis]) > 1e-12f ? along[axis] : 1e-12f);
    const float a = -from[axis] * inverse, b = (extent - from[axis]) * inverse;
    span = {std::max(span.from, std::min(a, b)), std::min(span.to, std::max(a, b))};
  }
  return span;
}

/// What a ray collects: light scattered to the eye, and the share of what is behind.
struct Collected {
  Vec3f light{};
  float left = 1;
};

Collected march(const Grid& extinction, const Grid& light, const RenderSmoke& smoke, const Vec3f& eye, const Vec3f& way,
                Span span) {
  const Vec3f sunlight{1.75f, 1.66f, 1.50f}, sky{0.62f, 0.68f, 0.78f};
  Collected sum;
  const float step = 0.8f * extinction.cell;
  for (float t = span.from + 0.5f * step; t < span.to && sum.left > 0.01f; t += step) {
    const Vec3f p = eye + way * t;
    const float density = extinction.at(p);
    if (!(density > 0)) continue;
    const float taken = sum.left * (1 - std::exp(-density * step)), lit = light.at(p);
    const auto scattered = [&](float sun, float around, float colour) { return taken * colour * (sun * lit + around); };
    sum.light += {scattered(sunlight.x, sky.x, smoke.colour.x), scattered(sunlight.y, sky.y, smoke.colour.y),
                  scattered(sunlight.z, sky.z, smoke.colour.z)};
    sum.left -= taken;
  }
  return sum;
}

/// Tone mapping as of surfaces (shaders.h), without the last power.
float developed(float light) {
  const float x = light * 0.47f;
  return std::clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.f, 1.f);
}

float decoded(std::uint8_t value) {
  const float x = static_cast<float>(value) / 255;
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t encoded(float x) {
  const float value = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.f, 1.f)));
}

void blend(const Collected& smoke, std::uint8_t* pixel) {
  const float taken = 1 - smoke.left;
  if (!(taken > 1e-3f)) return;
  const std::array<float, 3> light{smoke.light.x, smoke.light.y, smoke.light.z};
  for (std::size_t c = 0; c < 3; ++c)
    pixel[c] = encoded(smoke.left * decoded(pixel[c]) + taken * developed(light[c] / taken));
}

void draw(const RenderSmoke& smoke, const SmokeView& view, const std::vector<float>& depths,
          std::vector<std::uint8_t>& rgb) {
  const Grid extinction = extinction_of(smoke), light = light_in(extinction, view.sun);
  const auto place = [](int pixel, int all) {
    return (2 * (static_cast<float>(pixel) + 0.5f) / static_cast<float>(all)) - 1;
  };
  on_all_threads(view.height, [&](int row) {
    for (int column = 0; column < view.width; ++column) {
      const Vec3f ahead = view.frame.right * (place(column, view.width) * view.half_width) -
                          view.frame.up * (place(row, view.height) * view.half_height) - view.frame.back;
      const float scale = length(ahead);
      const std::size_t below = static_cast<std::size_t>(view.height - 1 - row), x = static_cast<std::size_t>(column);
      const float d = 2 * depths[below * static_cast<std::size_t>(view.width) + x] - 1;
      const float seen = 2 * view.near * view.far / (view.far + view.near - d * (view.far - view.near));
      Span span = span_in(extinction, view.eye, ahead * (1 / scale));
      span.to = std::min(span.to, seen * scale);
      if (!(span.from < span.to)) continue;
      blend(march(extinction, light, smoke, view.eye, ahead * (1 / scale), span),
            &rgb[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(view.width) + x)]);
    }
  });
}

}  // namespace

void draw_smoke(const std::vector<RenderSmoke>& smokes, const SmokeView& view, const std::vector<float>& depths,
                std::vector<std::uint8_t>& rgb) {
  for (const RenderSmoke& smoke : smokes)
    if (!smoke.centres.empty()) draw(smoke, view, depths, rgb);
}

}  // namespace pliant::render
