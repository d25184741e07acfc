// The readings of gauges as a table in CSV (RFC 4180): a heading, then a row for each frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "atomic_file.h"
#include "pliant/gauges.h"
#include "pliant/io.h"

namespace pliant::command {

class GaugeTable {
 public:
  /// Does nothing if `path` is empty. Throws an Error if the scene has no gauges, or the file cannot be written.
  GaugeTable(const std::string& path, const SceneFile& scene, World& world);

  void add(const World& world);  ///< call once for the initial state and once after each step
  void finish();                 ///< completes the file
  std::vector<WrittenFile> written() const;

 private:
  std::unique_ptr<AtomicFile> file_;
  std::unique_ptr<Gauges> gauges_;
};

/// A field of a row, in quotes if it needs them.
std::string csv_field(const std::string& text);

}  // namespace pliant::command
