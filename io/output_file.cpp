// Files in memory.
#include "output_file.h"

#include <cstring>
#include <utility>
#include <vector>

#include "atomic_file.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Bytes that go to a sink at commit().
class MemoryFile final : public OutputFile {
 public:
  MemoryFile(std::string path, std::shared_ptr<const FileSink> sink) : path_(std::move(path)), sink_(std::move(sink)) {}

  using OutputFile::write;
  void write(const void* bytes, std::size_t count) override {
    const auto* const first = static_cast<const std::byte*>(bytes);
    bytes_.insert(bytes_.end(), first, first + count);
    size_ += count;
  }

  void overwrite(std::size_t offset, const void* bytes, std::size_t count) override {
    if (offset + count > bytes_.size())
      throw Error({.file = path_, .line = 0, .object = {}, .element = {}},
                  "cannot overwrite bytes beyond the end of the file");
    std::memcpy(bytes_.data() + offset, bytes, count);
  }

  std::size_t size() const override { return size_; }
  void commit() override { (*sink_)(path_, std::move(bytes_)); }
  const std::string& path() const override { return path_; }

 private:
  std::string path_;
  std::shared_ptr<const FileSink> sink_;
  std::vector<std::byte> bytes_;
  std::size_t size_ = 0;  ///< also known after the bytes are gone
};

}  // namespace

std::unique_ptr<OutputFile> output::Destination::open(const std::string& file) const {
  if (is_disk()) return std::make_unique<AtomicFile>(file);
  return std::make_unique<MemoryFile>(file, sink);
}

}  // namespace pliant
