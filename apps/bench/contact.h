// The cost of contact between surfaces: a cloth over a ball with and without self-collision, in frames that alternate
// between both. `pliant bench contact` prints it.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

/// Medians over frames, in processor time of one thread.
struct ContactRow {
  /// N for N x N particles in all, edges of 1 cm, a ball as wide as the cloth; multiples of 100: several cloths.
  int size = 0;
  int particles = 0;
  double without_ms = 0, with_ms = 0;  ///< milliseconds per frame without and with self-collision
  double ratio = 0;                    ///< with_ms over without_ms
  double largest_ms = 0;               ///< slowest frame with self-collision
  double with_us_per_particle = 0;
  double candidates_per_particle = 0;  ///< pairs in near lists and static pairs, per particle
  double lists = 0;                    ///< mean number of near-list rebuilds per frame
};

struct ContactOptions {
  std::vector<int> sizes{100};
  int frames = 60;  ///< number of frames from the start, all measured: fall, landing and draping
  std::function<void(const ContactRow&)> on_row;
};

/// Measures each size. Throws an Error if a size is outside 2..4096 or there are no frames.
std::vector<ContactRow> measure_contact(const ContactOptions& options);

std::string to_json(const std::vector<ContactRow>& rows);

}  // namespace pliant::bench
