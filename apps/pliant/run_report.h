// The report of a run: collected frame by frame, and written as JSON (docs/reference/command.md lists its fields).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pliant/advise.h"
#include "pliant/edit.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::command {

/// The quantile q, 0..1, of the values, interpolated linearly; 0 if there are none.
double quantile(std::vector<double> values, double q);

/// What tore and was cut in all frames.
struct Tears {
  std::int64_t new_particles = 0, lost_constraints = 0, broken_joints = 0;
  std::int64_t first_frame = -1;  ///< -1: nothing tore
};

class RunReport {
 public:
  explicit RunReport(bool hash_frames) : hash_frames_(hash_frames) {}

  /// Adds the figures of a frame; call it after each.
  void add(const Report& report, const World& world);

  /// The report as JSON. Figures are those of the last frame unless docs say otherwise; times are over all frames.
  std::string json(const std::string& scene_path, const Scene& scene, const World& world) const;

  /// What to do about the worst frame's overstretch; empty if all frames are within the bounds.
  std::string advice(const World& world) const;

  double median_milliseconds() const { return quantile(milliseconds_, 0.5); }
  double p95_milliseconds() const { return quantile(milliseconds_, 0.95); }
  std::size_t frames() const { return milliseconds_.size(); }  ///< number of frames simulated in this run
  const Report& last() const { return last_; }
  /// For each kind of warning the first one, with its frame. Warnings that differ only in numbers are of one kind.
  /// The last ones are of liquids that were compressed by more than 1 % on average, of tetrahedra turned inside out,
  /// and of what was far from converged (unconverged).
  std::vector<std::string> warnings(const World& world) const;
  const Tears& tears() const { return tears_; }
  const FlowReport& flow() const { return flow_; }

 private:
  void add(const Compression& compression, std::int64_t frame);
  void add(const TetrahedraMeasure& tetrahedra, std::int64_t frame);

  bool hash_frames_;
  Report last_;
  IterationCount iterations_;  ///< until it is written, `mean` has the sum over frames
  int most_substeps_ = 0;      ///< of any frame
  std::int64_t sum_of_substeps_ = 0;
  TieGap widest_tie_;  ///< of any frame
  std::int64_t frame_of_tie_ = 0;
  FlowReport flow_;  ///< sums over frames; `present` of the last frame
  Tears tears_;
  Compression worst_compression_;  ///< the largest mean and the largest maximum of any frame
  std::int64_t frame_of_mean_ = 0, frame_of_largest_ = 0;
  TetrahedraMeasure worst_tetrahedra_;  ///< of the frame with the most inverted ones, or with the smallest
  std::int64_t frame_of_tetrahedra_ = 0;
  LostMomentum lost_momentum_;  ///< of all frames
  PairReport pairs_;            ///< candidates, contacts and intersections of the last frame; other counts summed
  std::vector<double> milliseconds_;
  std::map<std::string, double> phase_sums_;
  std::vector<std::string> hashes_;
  WarningLog warnings_;
};

}  // namespace pliant::command
