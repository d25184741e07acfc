// The baseline: PBD as a competent programmer writes it in an hour. Array of structs, constraints in the order of the
// mesh, float, one thread, the same compiler flags as the engine.
#include <cmath>

#include "apps/bench/cloth.h"

namespace pliant::bench {
namespace {

struct Particle {
  Vec3f position, previous, velocity;
  float inverse_mass;
};

class PlainLoop final : public Engine {
 public:
  PlainLoop(const Cloth& cloth, Steps steps) : edges_(cloth.edges), hinges_(cloth.hinges), steps_(steps) {
    for (std::size_t i = 0; i < cloth.object.positions.size(); ++i) {
      const Vec3f& x = cloth.object.positions[i];
      particles_.push_back({x, x, {}, 1 / cloth.object.masses[i]});
    }
    for (int pin : cloth.pins) particles_[pin].inverse_mass = 0;
  }

  void step(float dt) override {
    const float h = dt / static_cast<float>(steps_.substeps);
    for (int i = 0; i < steps_.substeps; ++i) {
      predict(h);
      for (int k = 0; k < steps_.iterations; ++k) {
        stretch();
        bend(h);
      }
      update(h);
    }
  }

  std::vector<Vec3f> positions() const override {
    std::vector<Vec3f> result;
    for (const Particle& p : particles_) result.push_back(p.position);
    return result;
  }

 private:
  void predict(float h) {
    for (Particle& p : particles_) {
      p.previous = p.position;
      if (p.inverse_mass == 0) continue;
      p.velocity.y -= 9.81f * h;
      p.position += p.velocity * h;
    }
  }

  void stretch() {
    for (const Edge& edge : edges_) {
      Particle &a = particles_[edge.a], &b = particles_[edge.b];
      const float weight = a.inverse_mass + b.inverse_mass;
      if (weight == 0) continue;
      const Vec3f d = b.position - a.position;
      const float length = std::sqrt(dot(d, d));
      if (length == 0) continue;
      const Vec3f correction = d * ((length - edge.rest_length) / (length * weight));
      a.position += correction * a.inverse_mass;
      b.position -= correction * b.inverse_mass;
    }
  }

  // XPBD without a stored multiplier, which is exact for one iteration per substep; more iterations would make a
  // stiffer spring.
  void bend(float h) {
    for (const Hinge& hinge : hinges_) {
      Particle &p0 = particles_[hinge.v0], &p1 = particles_[hinge.v1], &p2 = particles_[hinge.v2],
               &p3 = particles_[hinge.v3];
      const Vec3f e = p1.position - p0.position, a = p2.position - p0.position, b = p3.position - p0.position;
      const Vec3f n1 = cross(e, a), n2 = cross(b, e);
      const float edge = std::sqrt(dot(e, e)), n1n1 = dot(n1, n1), n2n2 = dot(n2, n2);
      if (edge == 0 || n1n1 == 0 || n2n2 == 0) continue;
      const float angle = std::atan2(-edge * dot(n1, b), dot(n1, n2));
      const Vec3f g2 = n1 * (-edge / n1n1), g3 = n2 * (-edge / n2n2);
      const float per_e2 = 1 / (edge * edge), t1 = dot(a, e) * per_e2, t2 = dot(b, e) * per_e2;
      const Vec3f g1 = -(g2 * t1 + g3 * t2), g0 = -(g1 + g2 + g3);
      const float weight = p0.inverse_mass * dot(g0, g0) + p1.inverse_mass * dot(g1, g1) +
                           p2.inverse_mass * dot(g2, g2) + p3.inverse_mass * dot(g3, g3);
      const float denominator = weight + hinge.compliance / (h * h);
      if (denominator == 0) continue;
      const float change = -angle / denominator;
      p0.position += g0 * (p0.inverse_mass * change);
      p1.position += g1 * (p1.inverse_mass * change);
      p2.position += g2 * (p2.inverse_mass * change);
      p3.position += g3 * (p3.inverse_mass * change);
    }
  }

  void update(float h) {
    const float rate = 1 / h;
    for (Particle& p : particles_) p.velocity = (p.position - p.previous) * rate;
  }

  std::vector<Particle> particles_;
  std::vector<Edge> edges_;
  std::vector<Hinge> hinges_;
  Steps steps_;
};

}  // namespace

std::unique_ptr<Engine> make_plain_loop(const Cloth& cloth, Steps steps) {
  return std::make_unique<PlainLoop>(cloth, steps);
}

}  // namespace pliant::bench
