// What contact among surfaces costs: one cloth over one ball, with self-collision and without, frame by frame in turn.
// `pliant bench contact` prints it.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

/// Medians over frames, processor time of one thread.
struct ContactRow {
  int size =
      0;  ///< N of an N x N cloth with edges of 1 cm, over a ball as large as it; multiples of 100: as many cloths as make N x N
  int particles = 0;
  double without_ms = 0, with_ms = 0;  ///< a frame
  double ratio = 0;                    ///< with over without
  double largest_ms = 0;               ///< with, the slowest frame
  double with_us_per_particle = 0;
  double candidates_per_particle = 0;  ///< pairs kept in lists
  double lists = 0;                    ///< times that two clusters' pairs were looked for in a frame, mean
};

struct ContactOptions {
  std::vector<int> sizes{100};
  int frames = 60;  ///< from the start: the fall, the landing and the draping
  std::function<void(const ContactRow&)> on_row;
};

/// Throws Error where a size is out of 2..4096 or there are no frames.
std::vector<ContactRow> measure_contact(const ContactOptions& options);

std::string to_json(const std::vector<ContactRow>& rows);

}  // namespace pliant::bench
