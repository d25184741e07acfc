// Ropes that break, for formats whose lines stay the same: each link has two vertices of its own. Those of a link that
// broke are in one place, so it is not seen.
#include <algorithm>
#include <array>
#include <utility>

#include "pliant/error.h"
#include "write_frames.h"

namespace pliant::output {

namespace {

using Link = std::array<int, 2>;  ///< the lower particle first

std::vector<Link> links_of(const std::vector<std::vector<int>>& lines) {
  std::vector<Link> links;
  for (const std::vector<int>& line : lines)
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      links.push_back({std::min(line[i], line[i + 1]), std::max(line[i], line[i + 1])});
  std::sort(links.begin(), links.end());
  return links;
}

class SegmentWriter final : public FormatWriter {
 public:
  SegmentWriter(Objects objects, const std::function<std::unique_ptr<FormatWriter>(const Objects&)>& make)
      : objects_(std::move(objects)) {
    Objects divided = objects_;
    for (FrameObject& object : divided) {
      links_.push_back(object.is_relinked ? links_of(object.lines) : std::vector<Link>{});
      if (object.is_relinked) divide(object, links_.back().size());
    }
    format_ = make(divided);
  }

  void add(const Frame& frame) override {
    Frame divided = frame;
    divided.lines.clear();
    for (std::size_t o = 0; o < std::min(objects_.size(), frame.positions.size()); ++o)
      if (objects_[o].is_relinked) divide(frame, o, divided);
    format_->add(divided);
  }

  void finish() override { format_->finish(); }
  const std::vector<WrittenFile>& written() const override { return format_->written(); }

 private:
  static void divide(FrameObject& object, std::size_t links) {
    object.is_relinked = false;
    object.particles = 2 * static_cast<int>(links);
    object.lines.clear();
    for (int i = 0; i < object.particles; i += 2) object.lines.push_back({i, i + 1});
  }

  void divide(const Frame& frame, std::size_t o, Frame& divided) const {
    if (frame.lines.size() != objects_.size())
      throw Error({"", 0, objects_[o].name, ""}, "a frame lacks the links that are left");
    const std::vector<Link> left = links_of(frame.lines[o]);
    if (!std::includes(links_[o].begin(), links_[o].end(), left.begin(), left.end()))
      throw Error({"", 0, objects_[o].name, ""}, "has links that were not there at the start",
                  "write .obj, .ply, .usda or .pvd");
    std::vector<Vec3f>& ends = divided.positions[o];
    ends.clear();
    auto next = left.begin();
    for (const Link& link : links_[o]) {
      const bool is_left = next != left.end() && *next == link;
      if (is_left) ++next;
      const Vec3f first = frame.positions[o].at(static_cast<std::size_t>(link[0]));
      ends.push_back(first);
      ends.push_back(is_left ? frame.positions[o].at(static_cast<std::size_t>(link[1])) : first);
    }
    if (!divided.velocities.empty()) divided.velocities[o].assign(ends.size(), {});  // no such format has velocities
  }

  Objects objects_;
  std::vector<std::vector<Link>> links_;  ///< of each object that is relinked, at the start, ascending
  std::unique_ptr<FormatWriter> format_;
};

}  // namespace

std::unique_ptr<FormatWriter> make_segment_writer(
    const Objects& objects, const std::function<std::unique_ptr<FormatWriter>(const Objects&)>& make) {
  const auto is_relinked = [](const FrameObject& object) { return object.is_relinked; };
  if (std::none_of(objects.begin(), objects.end(), is_relinked)) return make(objects);
  return std::make_unique<SegmentWriter>(objects, make);
}

}  // namespace pliant::output
