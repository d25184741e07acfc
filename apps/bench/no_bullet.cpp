// Stands in where Bullet was not found.
#include "apps/bench/cloth.h"

namespace pliant::bench {

std::unique_ptr<Engine> make_bullet(const Cloth&, Steps, BulletOrder) { return nullptr; }

}  // namespace pliant::bench
