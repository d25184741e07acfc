// Stands in for the Bullet engines in programs built without Bullet.
#include "apps/bench/cloth.h"
#include "apps/bench/landing.h"
#include "apps/bench/piles.h"

namespace pliant::bench {

std::unique_ptr<Engine> make_bullet(const Cloth&, Steps, BulletOrder) { return nullptr; }

std::unique_ptr<LandingEngine> make_bullet_landing(const Landing&, Steps, int) { return nullptr; }

std::unique_ptr<PileEngine> make_bullet_pile(const Pile&, int) { return nullptr; }

}  // namespace pliant::bench
