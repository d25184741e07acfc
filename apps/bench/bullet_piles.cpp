// Bullet's rigid bodies with its default solver and settings. Compiled only if Bullet is present.
#include <btBulletDynamicsCommon.h>

#include <cmath>

#include "apps/bench/bullet_vector.h"
#include "apps/bench/piles.h"

namespace pliant::bench {
namespace {

constexpr float density = 1000;

Vec3f from_bullet(const btVector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
btTransform to_transform(const Vec3f& position, const Quatf& q) {
  return btTransform(btQuaternion(q.x, q.y, q.z, q.w), to_bullet(position));
}

struct MakeShape {
  std::unique_ptr<btCollisionShape> operator()(const Sphere& s) const {
    return std::make_unique<btSphereShape>(s.radius);
  }
  std::unique_ptr<btCollisionShape> operator()(const Capsule& s) const {
    return std::make_unique<btCapsuleShape>(s.radius, 2 * s.half_length);
  }
  std::unique_ptr<btCollisionShape> operator()(const Box& s) const {
    return std::make_unique<btBoxShape>(to_bullet(s.half_extents));
  }
  std::unique_ptr<btCollisionShape> operator()(const Cylinder& s) const {
    return std::make_unique<btCylinderShape>(btVector3(s.radius, s.half_length, s.radius));
  }
};

struct Volume {
  static constexpr float pi = 3.14159265f;
  float operator()(const Sphere& s) const { return 4 * pi / 3 * s.radius * s.radius * s.radius; }
  float operator()(const Capsule& s) const { return pi * s.radius * s.radius * (4 * s.radius / 3 + 2 * s.half_length); }
  float operator()(const Box& s) const { return 8 * s.half_extents.x * s.half_extents.y * s.half_extents.z; }
  float operator()(const Cylinder& s) const { return 2 * pi * s.radius * s.radius * s.half_length; }
};

class BulletPile final : public PileEngine {
 public:
  BulletPile(const Pile& pile, int substeps)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        substeps_(substeps) {
    world_.setGravity(btVector3(0, btScalar(-9.81), 0));
    for (const PileBody& body : pile.bodies)
      add(std::visit(MakeShape{}, body.shape), density * std::visit(Volume{}, body.shape),
          to_transform(body.position, body.rotation), pile.friction);
    bodies_ = added_.size();
    for (const PilePlane& plane : pile.planes)
      add(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0,
          to_transform(plane.position, plane.rotation), pile.friction);
    if (!pile.bowl.triangles.empty()) add_bowl(pile);
  }

  ~BulletPile() override {
    for (const auto& body : added_) world_.removeRigidBody(body.get());
  }

  void step(float dt) override {
    for (int i = 0; i < substeps_; ++i) world_.stepSimulation(dt / static_cast<float>(substeps_), 0);
  }

  std::vector<Vec3f> positions() const override {
    std::vector<Vec3f> result;
    for (std::size_t i = 0; i < bodies_; ++i) result.push_back(from_bullet(added_[i]->getWorldTransform().getOrigin()));
    return result;
  }
  std::vector<Vec3f> velocities() const override {
    std::vector<Vec3f> result;
    for (std::size_t i = 0; i < bodies_; ++i) result.push_back(from_bullet(added_[i]->getLinearVelocity()));
    return result;
  }
  int substeps() const override { return substeps_; }

 private:
  void add_bowl(const Pile& pile) {
    bowl_ = std::make_unique<btTriangleMesh>();
    for (const auto& [a, b, c] : pile.bowl.triangles)
      bowl_->addTriangle(to_bullet(pile.bowl.positions[static_cast<std::size_t>(a)]),
                         to_bullet(pile.bowl.positions[static_cast<std::size_t>(b)]),
                         to_bullet(pile.bowl.positions[static_cast<std::size_t>(c)]));
    add(std::make_unique<btBvhTriangleMeshShape>(bowl_.get(), true), 0, btTransform::getIdentity(), pile.friction);
  }

  /// Bullet multiplies the friction of both sides, so each gets the square root.
  void add(std::unique_ptr<btCollisionShape> shape, float mass, const btTransform& pose, float friction) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
    info.m_startWorldTransform = pose;
    info.m_friction = std::sqrt(friction);
    added_.push_back(std::make_unique<btRigidBody>(info));
    added_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(added_.back().get());
    shapes_.push_back(std::move(shape));
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::unique_ptr<btTriangleMesh> bowl_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> added_;
  std::size_t bodies_ = 0;
  int substeps_;
};

}  // namespace

std::unique_ptr<PileEngine> make_bullet_pile(const Pile& pile, int substeps) {
  return std::make_unique<BulletPile>(pile, substeps);
}

}  // namespace pliant::bench
