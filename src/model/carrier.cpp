#include "model/carrier.h"

#include "math/vector.h"

namespace pliant {

namespace {

/// The corners of a rigid mesh's bounding box: no vertex moves farther than the farthest corner.
struct BoxCorners {
  Vec3d at[8];
};

BoxCorners box_corners_of(const std::vector<Vec3f>& points) {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const Vec3f& point : points) {
    low = min(low, convert<double>(point));
    high = max(high, convert<double>(point));
  }
  BoxCorners corners;
  for (int i = 0; i < 8; ++i)
    corners.at[i] = {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z};
  return corners;
}

void include(CarrierBox& box, const Vec3d& p) {
  box.low = min(box.low, p);
  box.high = max(box.high, p);
}

}  // namespace

CarrierPose::CarrierPose(const Carrier& carrier, double time)
    : CarrierPose(carrier, time, pose_at(carrier.motion, time)) {}

CarrierPose::CarrierPose(const Carrier& carrier, double time, const Posed& pose)
    : pose_(pose), before_(&carrier.rest), after_(&carrier.rest) {
  if (!carrier.deforms()) return;
  const TimePlace at = place_in(carrier.times, carrier.repeat, time);
  before_ = &carrier.frames[at.before];
  after_ = &carrier.frames[at.after];
  share_ = at.share;
}

Vec3d CarrierPose::place(int particle) const {
  const auto i = static_cast<std::size_t>(particle);
  const Vec3d from = convert<double>((*before_)[i]);
  if (share_ == 0) return to_world(pose_, from);
  return to_world(pose_, from + (convert<double>((*after_)[i]) - from) * share_);
}

double largest_move(const Carrier& carrier, double from, double to) {
  double most = 0;
  const auto look_at = [&](const Vec3d& a, const Vec3d& b) { most = max(most, dot(b - a, b - a)); };
  if (carrier.deforms()) {
    const CarrierPose before(carrier, from), after(carrier, to);
    for (int i = 0; i < static_cast<int>(carrier.rest.size()); ++i) look_at(before.place(i), after.place(i));
  } else {
    const Posed before = pose_at(carrier.motion, from), after = pose_at(carrier.motion, to);
    for (const Vec3d& corner : box_corners_of(carrier.rest).at)
      look_at(to_world(before, corner), to_world(after, corner));
  }
  return sqrt(most);
}

CarrierBox box_at(const Carrier& carrier, double time) {
  CarrierBox box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  if (carrier.deforms()) {
    const CarrierPose pose(carrier, time);
    for (int i = 0; i < static_cast<int>(carrier.rest.size()); ++i) include(box, pose.place(i));
  } else {
    const Posed pose = pose_at(carrier.motion, time);
    for (const Vec3d& corner : box_corners_of(carrier.rest).at) include(box, to_world(pose, corner));
  }
  return box;
}

}  // namespace pliant
