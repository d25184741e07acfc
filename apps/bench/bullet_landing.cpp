// Bullet's soft bodies with self-collision, set up like its own
// examples of cloth clusters. Compiled only if Bullet is present.
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyInternals.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "apps/bench/bullet_vector.h"
#include "apps/bench/landing.h"

namespace pliant::bench {
namespace {

class BulletLanding final : public LandingEngine {
 public:
  BulletLanding(const Landing& landing, Steps steps, int clusters)
      : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &solver_, &configuration_), steps_(steps) {
    world_.setGravity(btVector3(0, btScalar(-9.81), 0));
    world_.getWorldInfo().m_gravity = world_.getGravity();
    world_.getWorldInfo().m_sparsesdf.Initialize();
    add_ball(landing);
    for (std::size_t c = 0; c < landing.cloths.size(); ++c) add_cloth(landing.cloths[c], landing.edges[c], clusters);
  }

  ~BulletLanding() override {
    for (const auto& body : cloths_) world_.removeSoftBody(body.get());
    if (ball_) world_.removeRigidBody(ball_.get());
  }

  // In Bullet 3.24 the flag for self-collision by clusters (CL_SELF) switches off all contact of soft bodies, because
  // the handler's mask contains it. So contact is called here, at the end of a step.
  void step(float dt) override {
    const float h = dt / static_cast<float>(steps_.substeps);
    for (const auto& body : cloths_) body->m_cfg.kDP = 1 - 1 / (1 + h * damping_);
    for (int i = 0; i < steps_.substeps; ++i) {
      world_.stepSimulation(h, 0);
      for (const auto& body : cloths_) btSoftColliders::CollideCL_SS().ProcessSoftSoft(body.get(), body.get());
    }
  }

  std::vector<Vec3f> positions(int cloth) const override {
    const btSoftBody& body = *cloths_[static_cast<std::size_t>(cloth)];
    std::vector<Vec3f> result;
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      const btVector3& x = body.m_nodes[i].m_x;
      result.push_back({static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z())});
    }
    return result;
  }

 private:
  void add_ball(const Landing& landing) {
    if (!(landing.radius > 0)) return;
    shape_ = std::make_unique<btSphereShape>(landing.radius);
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape_.get());
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(to_bullet(landing.ball));
    ball_ = std::make_unique<btRigidBody>(info);
    world_.addRigidBody(ball_.get());
  }

  void add_cloth(const Object& object, const std::vector<Edge>& edges, int clusters) {
    cloths_.push_back(make_body(object, edges));
    btSoftBody& body = *cloths_.back();
    body.m_cfg.collisions = btSoftBody::fCollision::SDF_RS | btSoftBody::fCollision::CL_SS;
    body.m_cfg.kSSHR_CL = 1;
    body.m_cfg.kSS_SPLT_CL = 0;
    body.m_cfg.kDF = btScalar(object.kinetic_friction);
    damping_ = object.damping;
    btSoftBodyHelpers::ReoptimizeLinkOrder(&body);
    body.generateClusters(clusters);
    world_.addSoftBody(&body);
  }

  std::unique_ptr<btSoftBody> make_body(const Object& object, const std::vector<Edge>& edges) {
    std::vector<btVector3> places;
    std::vector<btScalar> masses;
    for (std::size_t i = 0; i < object.positions.size(); ++i) {
      places.push_back(to_bullet(object.positions[i]));
      masses.push_back(object.masses[i]);
    }
    auto body = std::make_unique<btSoftBody>(&world_.getWorldInfo(), static_cast<int>(places.size()), places.data(),
                                             masses.data());
    body->m_materials[0]->m_kLST = 1;
    for (const Edge& edge : edges) body->appendLink(edge.a, edge.b);
    for (const auto& [a, b, c] : object.triangles) body->appendFace(a, b, c);
    for (const Pin& pin : object.pins) body->setMass(pin.particle, 0);
    body->getCollisionShape()->setMargin(object.thickness);
    body->m_cfg.piterations = steps_.iterations;
    body->m_cfg.viterations = 0;
    return body;
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_;
  std::unique_ptr<btCollisionShape> shape_;
  std::unique_ptr<btRigidBody> ball_;
  std::vector<std::unique_ptr<btSoftBody>> cloths_;
  Steps steps_;
  float damping_ = 0;  ///< damping of velocities [1/s]
};

}  // namespace

std::unique_ptr<LandingEngine> make_bullet_landing(const Landing& landing, Steps steps, int clusters) {
  return std::make_unique<BulletLanding>(landing, steps, clusters);
}

}  // namespace pliant::bench
