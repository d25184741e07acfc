#include "collision/bodies/body_crowds.h"

#include <map>

namespace pliant {

namespace {

/// A smaller family is with all others: each tree costs a search.
constexpr int least_of_family = 64;
constexpr int packets_a_task = 8;

}  // namespace

BodyCrowds::BodyCrowds(const std::vector<int>& family) : crowd_of_(family.size(), 0) {
  std::map<int, int> counts, number;
  for (const int one : family) ++counts[one];
  for (std::size_t i = 0; i < family.size(); ++i) {
    const bool is_large = family[i] >= 0 && counts[family[i]] >= least_of_family;
    if (is_large) {
      const auto [found, added] = number.try_emplace(family[i], static_cast<int>(crowds_.size()));
      if (added) crowds_.emplace_back();
      crowd_of_[i] = found->second;
    }
    crowds_[static_cast<std::size_t>(crowd_of_[i])].members.push_back(static_cast<int>(i));
  }
}

void BodyCrowds::build(const std::vector<BoxBounds>& boxes) {
  for (Crowd& crowd : crowds_) {
    crowd.boxes.clear();
    for (const int part : crowd.members) crowd.boxes.push_back(boxes[static_cast<std::size_t>(part)]);
    crowd.tree.build(crowd.boxes);
  }
  tasks_.clear();
  for (int a = 0; a < static_cast<int>(crowds_.size()); ++a)
    for (int b = 0; b <= a; ++b) {
      if (a == b && a > 0) continue;
      const bool is_first_smaller = crowd(a).members.size() <= crowd(b).members.size();
      const int from = is_first_smaller ? a : b, to = is_first_smaller ? b : a;
      if (crowd(from).members.empty()) continue;
      const int packets = crowd(from).tree.packet_count();
      for (int first = 0; first < packets; first += packets_a_task)
        tasks_.push_back({from, to, first, std::min(first + packets_a_task, packets)});
    }
}

}  // namespace pliant
