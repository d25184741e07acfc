// Bullet's position based soft body on the same cloth, with the settings of Bullet's cloth
// examples: linear stiffness 1, position iterations only. Links are either shuffled, as
// its mesh helper leaves them, or reordered by its ReoptimizeLinkOrder helper. Contact is
// off, because the workload has none. Compiled only if Bullet is present.
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "apps/bench/bullet_vector.h"
#include "apps/bench/cloth.h"

namespace pliant::bench {
namespace {

class BulletCloth final : public Engine {
 public:
  BulletCloth(const Cloth& cloth, Steps steps, BulletOrder order)
      : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &solver_, &configuration_), steps_(steps) {
    world_.setGravity(btVector3(0, btScalar(-9.81), 0));
    world_.getWorldInfo().m_gravity = world_.getGravity();
    make_body(cloth, order);
    world_.addSoftBody(body_.get());
  }

  ~BulletCloth() override { world_.removeSoftBody(body_.get()); }

  void step(float dt) override {
    const float h = dt / static_cast<float>(steps_.substeps);
    for (int i = 0; i < steps_.substeps; ++i) world_.stepSimulation(h, 0);
  }

  std::vector<Vec3f> positions() const override {
    std::vector<Vec3f> result;
    for (int i = 0; i < body_->m_nodes.size(); ++i) {
      const btVector3& x = body_->m_nodes[i].m_x;
      result.push_back({static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z())});
    }
    return result;
  }

 private:
  void make_body(const Cloth& cloth, BulletOrder order) {
    const Object& object = cloth.object;
    std::vector<btVector3> places;
    std::vector<btScalar> masses;
    for (std::size_t i = 0; i < object.positions.size(); ++i) {
      places.push_back(to_bullet(object.positions[i]));
      masses.push_back(object.masses[i]);
    }
    body_ = std::make_unique<btSoftBody>(&world_.getWorldInfo(), static_cast<int>(places.size()), places.data(),
                                         masses.data());
    body_->m_materials[0]->m_kLST = 1;
    for (const Edge& edge : cloth.edges) body_->appendLink(edge.a, edge.b);
    for (int pin : cloth.pins) body_->setMass(pin, 0);
    body_->m_cfg.piterations = steps_.iterations;
    body_->m_cfg.viterations = 0;
    body_->m_cfg.collisions = 0;
    if (order == BulletOrder::spread)
      btSoftBodyHelpers::ReoptimizeLinkOrder(body_.get());
    else
      body_->randomizeConstraints();
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_;
  std::unique_ptr<btSoftBody> body_;
  Steps steps_;
};

}  // namespace

std::unique_ptr<Engine> make_bullet(const Cloth& cloth, Steps steps, BulletOrder order) {
  return std::make_unique<BulletCloth>(cloth, steps, order);
}

}  // namespace pliant::bench
