// Writes the ParaView format: NAME.pvd lists the times; NAME/OBJECT_0000.vtp has one frame of one object.
//
// Numbers are in base64 within the XML, which is exact and a third of the size of digits. There are many files of
// frames, so these have a folder of their own. The .pvd is written last, so it never names a missing file.
#include <sys/stat.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

#include "pliant/error.h"
#include "write_frames.h"
#include "write_text.h"

namespace pliant::output {

namespace {

/// Encodes bytes in base64, three bytes as four digits (RFC 4648).
std::string base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (unsigned k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (c == '&')
      text += "&amp;";
    else if (c == '<')
      text += "&lt;";
    else if (c == '>')
      text += "&gt;";
    else if (c == '"')
      text += "&quot;";
    else
      text += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return text;
}

template <class T>
std::string array(const char* type, const char* name, int components, const std::vector<T>& values) {
  const std::uint64_t size = values.size() * sizeof(T);
  std::string bytes(sizeof size + size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  std::string text = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\"";
  if (components > 1) text += " NumberOfComponents=\"" + std::to_string(components) + "\"";
  return text + " format=\"binary\">" + base64(bytes) + "</DataArray>\n";
}

/// The cells of one kind as text, which is the same in every frame.
template <class Cells>
std::string cells(const char* kind, const Cells& list) {
  std::vector<std::int64_t> connectivity, offsets;
  for (const auto& cell : list) {
    connectivity.insert(connectivity.end(), cell.begin(), cell.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  return std::string("<") + kind + ">\n" + array("Int64", "connectivity", 1, connectivity) +
         array("Int64", "offsets", 1, offsets) + "</" + kind + ">\n";
}

struct Piece {
  std::string name, head, cells;

  Piece(std::string file, const FrameObject& object) : name(std::move(file)) {
    const bool surface = object.is_surface(), lines = !surface && !object.lines.empty();
    std::vector<std::array<int, 1>> points;
    for (int i = 0; i < object.particles && !surface && !lines; ++i) points.push_back({i});
    const auto count = [](const char* kind, std::size_t n) {
      return std::string(" NumberOf") + kind + "=\"" + std::to_string(n) + "\"";
    };
    head =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<PolyData>\n<Piece" +
        count("Points", static_cast<std::size_t>(object.particles)) + count("Verts", points.size()) +
        count("Lines", lines ? object.lines.size() : 0) + count("Strips", 0) + count("Polys", object.triangles.size()) +
        ">\n";
    if (surface)
      cells = output::cells("Polys", object.triangles);
    else if (lines)
      cells = output::cells("Lines", object.lines);
    else
      cells = output::cells("Verts", points);
  }
};

class PvdWriter final : public FormatWriter {
 public:
  PvdWriter(const Destination& to, Objects objects)
      : to_(to), objects_(std::move(objects)), file_(to.open(to.path)), folder_(split_path(to.path).stem) {
    if (folder_ == to_.path) folder_ += "_frames";
    if (to_.is_disk() && ::mkdir(folder_.c_str(), 0777) != 0 && errno != EEXIST)
      throw Error({.file = folder_, .line = 0, .object = {}, .element = {}},
                  "cannot create the folder of the frames: " + std::generic_category().message(errno),
                  "write somewhere else");
    const std::vector<std::string> names = identifiers(objects_);
    for (std::size_t o = 0; o < objects_.size(); ++o) pieces_.emplace_back(names[o], objects_[o]);
  }

  void add(const Frame& frame) override {
    check_frame(to_.path, objects_, frame, last_time_);
    std::string time;
    append(time, frame.time);
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      const std::string name = pieces_[o].name + "_" + frame_number(frame.number) + ".vtp";
      write_piece(name, frame, o);
      entries_ += "<DataSet timestep=\"" + time + "\" group=\"\" part=\"" + std::to_string(o) + "\" name=\"" +
                  escaped(objects_[o].name) + "\" file=\"" + escaped(file_name(folder_)) + "/" + name + "\"/>\n";
    }
    last_time_ = frame.time;
  }

  void finish() override {
    if (std::exchange(finished_, true)) return;
    file_->write(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
        "byte_order=\"LittleEndian\">\n<Collection>\n");
    file_->write(entries_);
    file_->write("</Collection>\n</VTKFile>\n");
    commit(*file_);
  }

 private:
  /// What the frame has of an object that varies.
  static Frame part_of(const Frame& frame, std::size_t o) {
    Frame result;
    result.positions = {frame.positions[o]};
    if (!frame.triangles.empty()) result.triangles = {frame.triangles[o]};
    if (!frame.lines.empty()) result.lines = {frame.lines[o]};
    return result;
  }

  void write_piece(const std::string& name, const Frame& frame, std::size_t o) {
    const std::unique_ptr<OutputFile> file = to_.open(folder_ + "/" + name);
    if (is_any_varying({objects_[o]}))
      pieces_[o] = Piece(pieces_[o].name, present_objects({objects_[o]}, part_of(frame, o)).front());
    file->write(pieces_[o].head);
    if (!frame.velocities.empty() && !objects_[o].is_remeshed)
      file->write("<PointData Vectors=\"velocity\">\n" + array("Float32", "velocity", 3, frame.velocities[o]) +
                  "</PointData>\n");
    file->write("<Points>\n" + array("Float32", "Points", 3, frame.positions[o]) + "</Points>\n");
    file->write(pieces_[o].cells);
    file->write("</Piece>\n</PolyData>\n</VTKFile>\n");
    commit(*file);
  }

  Destination to_;
  Objects objects_;
  std::unique_ptr<OutputFile> file_;
  std::string folder_, entries_;
  std::vector<Piece> pieces_;
  bool finished_ = false;
  double last_time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<FormatWriter> make_pvd_writer(const Destination& to, const Objects& objects) {
  return std::make_unique<PvdWriter>(to, objects);
}

}  // namespace pliant::output
