// Estimates what contact costs at the start: the pairs of primitives within the thickness. Also checks rounding far
// from the origin.
//
// A vertex of a triangle mesh has two triangles and three edges. So each pair of near vertices means 2 vertex-triangle
// pairs and 3 x 3 / 2 edge-edge pairs, which contact stores in a list.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "inspect/problems.h"

namespace pliant {

namespace {

constexpr double pairs_of_surface = 6.5, pairs_of_rope = 0.5, bytes_of_pair = 24;
/// An object is rejected if it has more pairs per vertex and more than `most_pairs` in all. The limit is ten times what
/// cloth with a thickness of half an edge needs.
constexpr double most_pairs_of_vertex = 1000, most_pairs = 1e6;
/// A scene with more pairs is rejected (they take a gigabyte). The object with most pairs per vertex is named if above
/// many_pairs.
constexpr double most_pairs_of_scene = 4e7, many_pairs = 300;
/// Number of vertices that are sampled; each is compared with the vertices near it along x.
constexpr std::size_t samples = 256;
/// By how much near lists exceed the thickness (their skin), over the edge length.
constexpr double skin_over_edge = 0.75;
/// The filter's smallest margin between surfaces, over the largest coordinate: 32 roundings of a float.
constexpr double filter_roundings = 32 * 6e-8;

bool touches(const Object& object) { return object.self_collision || object.collides; }

bool can_collide(const Object& a, const Object& b) {
  if (&a == &b) return a.self_collision;
  return a.collides && b.collides && (a.groups & b.mask) != 0 && (b.groups & a.mask) != 0;
}

void check_place(Problems& problems, const Object& object, double edge) {
  float largest = 0;
  for (const Vec3f& p : object.positions) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (!(static_cast<double>(largest) * filter_roundings > edge)) return;
  problems.at(object.name);
  problems.grave("positions",
                 "are up to " + words(largest) + " m from the origin, where they are rounded to " +
                     words(static_cast<double>(largest) * 1.2e-7) + " m, and the median edge is " + words(edge) + " m",
                 "move the scene to within " + words(std::floor(edge / filter_roundings)) + " m of the origin");
}

struct Vertex {
  Vec3f x;
  int object;
};

class Neighbours {
 public:
  explicit Neighbours(const Scene& scene) : scene_(scene) {
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
      const Object& object = scene.objects[o];
      edge_.push_back(touches(object) ? median_edge(object) : 0);
      if (!touches(object) || edge_.back() == 0) continue;
      thickest_ = std::max(thickest_, static_cast<double>(object.thickness));
      for (const Vec3f& x : object.positions) all_.push_back({x, static_cast<int>(o)});
    }
    std::sort(all_.begin(), all_.end(), [](const Vertex& a, const Vertex& b) { return a.x.x < b.x.x; });
  }

  double edge(std::size_t object) const { return edge_[object]; }

  /// Calls visit(object, count) for vertices sampled evenly over all objects; `count` is the number of vertices in
  /// contact reach.
  template <class Visit>
  void sample(const Visit& visit) const {
    const std::size_t stride = std::max<std::size_t>(1, all_.size() / samples);
    for (std::size_t i = stride / 2; i < all_.size(); i += stride) visit(all_[i].object, count(all_[i]));
  }

 private:
  double count(const Vertex& v) const {
    const Object& own = scene_.objects[static_cast<std::size_t>(v.object)];
    const double skin = skin_over_edge * edge_[static_cast<std::size_t>(v.object)],
                 most = static_cast<double>(own.thickness) + thickest_ + skin;
    auto at = std::lower_bound(all_.begin(), all_.end(), static_cast<double>(v.x.x) - most,
                               [](const Vertex& a, double x) { return static_cast<double>(a.x.x) < x; });
    double found = 0;
    for (; at != all_.end() && static_cast<double>(at->x.x - v.x.x) <= most; ++at) {
      const Object& other = scene_.objects[static_cast<std::size_t>(at->object)];
      const double reach = static_cast<double>(own.thickness) + static_cast<double>(other.thickness) + skin;
      if (can_collide(own, other) && static_cast<double>(length_squared(at->x - v.x)) <= reach * reach) ++found;
    }
    return found;
  }

  const Scene& scene_;
  std::vector<double> edge_;  ///< median edge of each object [m]; 0: it has no contact
  std::vector<Vertex> all_;   ///< all vertices, ascending by x
  double thickest_ = 0;
};

void refuse_thickness(Problems& problems, const Object& object, double edge, double of_vertex) {
  const double all = of_vertex * static_cast<double>(object.positions.size());
  char text[200];
  std::snprintf(text, sizeof text,
                " m, and the median edge is %.3g m: contact would test about %.0f pairs per vertex, %.2g million in "
                "all, in %.0f MB",
                edge, of_vertex, 1e-6 * all, 1e-6 * bytes_of_pair * all);
  problems.at(object.name);
  problems.grave(
      "thickness", "is " + words(object.thickness) + text,
      "give " + words(0.5 * edge) + " m or less, so that two layers are at most an edge apart, or use a coarser mesh");
}

}  // namespace

void check_contact_cost(Problems& problems, const Scene& scene) {
  if (std::none_of(scene.objects.begin(), scene.objects.end(), touches)) return;
  const Neighbours neighbours(scene);
  std::vector<double> sum(scene.objects.size(), 0), count(scene.objects.size(), 0);
  for (std::size_t o = 0; o < scene.objects.size(); ++o)
    if (neighbours.edge(o) > 0) check_place(problems, scene.objects[o], neighbours.edge(o));
  neighbours.sample([&](int object, double found) {
    sum[static_cast<std::size_t>(object)] += found;
    ++count[static_cast<std::size_t>(object)];
  });
  double total = 0, most = 0;
  std::size_t worst = 0;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (count[o] == 0) continue;
    const Object& object = scene.objects[o];
    const double of_vertex = (object.triangles.empty() ? pairs_of_rope : pairs_of_surface) * sum[o] / count[o],
                 all = of_vertex * static_cast<double>(object.positions.size());
    if (of_vertex > most_pairs_of_vertex && all > most_pairs)
      return refuse_thickness(problems, object, neighbours.edge(o), of_vertex);
    total += all;
    if (of_vertex > most) worst = o;
    most = std::max(most, of_vertex);
  }
  if (total > most_pairs_of_scene && most > many_pairs)
    refuse_thickness(problems, scene.objects[worst], neighbours.edge(worst), most);
}

}  // namespace pliant
