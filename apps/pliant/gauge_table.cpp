#include "gauge_table.h"

#include <fmt/format.h>

#include <cmath>

#include "pliant/error.h"

namespace pliant::command {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

GaugeTable::GaugeTable(const std::string& path, const SceneFile& scene, World& world) {
  if (path.empty()) return;
  if (scene.gauges.empty()) {
    Location where;
    where.file = path;
    throw Error(where, "the scene has no gauges to write", "add \"gauges\" to the scene, or leave out --gauges");
  }
  gauges_ = std::make_unique<Gauges>(scene.gauges, scene.scene, world);
  file_ = std::make_unique<AtomicFile>(path);
  std::string head = "time [s]";
  for (const Gauge& gauge : scene.gauges) head += "," + csv_field(gauge.name + " [" + unit_of(gauge) + "]");
  file_->write(head + "\n");
}

void GaugeTable::add(const World& world) {
  if (gauges_ == nullptr) return;
  std::string row = fmt::format("{}", world.state().time);
  for (const double value : gauges_->read(world)) row += std::isnan(value) ? "," : fmt::format(",{}", value);
  file_->write(row + "\n");
}

void GaugeTable::finish() {
  if (file_ != nullptr) file_->commit();
}

std::vector<WrittenFile> GaugeTable::written() const {
  if (file_ == nullptr) return {};
  return {{file_->path(), file_->size()}};
}

}  // namespace pliant::command
