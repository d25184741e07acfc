// The cost of surface contact: one cloth over one ball, with and without self-collision, in alternating frames.
// `pliant bench contact` prints it.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

/// Medians over frames, processor time of one thread.
struct ContactRow {
  int size =
      0;  ///< N of an N x N cloth with edges of 1 cm, over a ball as wide; multiples of 100: several cloths, N x N in sum
  int particles = 0;
  double without_ms = 0, with_ms = 0;  ///< milliseconds per frame without and with self-collision
  double ratio = 0;                    ///< with_ms over without_ms
  double largest_ms = 0;               ///< slowest frame with self-collision
  double with_us_per_particle = 0;
  double candidates_per_particle = 0;  ///< pairs stored in lists
  double lists = 0;                    ///< near-list rebuilds per frame, mean
};

struct ContactOptions {
  std::vector<int> sizes{100};
  int frames = 60;  ///< measured frames from the start: fall, landing and draping
  std::function<void(const ContactRow&)> on_row;
};

/// Throws an Error if a size is outside 2..4096 or there are no frames.
std::vector<ContactRow> measure_contact(const ContactOptions& options);

std::string to_json(const std::vector<ContactRow>& rows);

}  // namespace pliant::bench
