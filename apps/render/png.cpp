// Writes PNG files.
#include "io/atomic_file.h"
#include "pliant/error.h"
#include "render.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace pliant::render {

void write_png(const std::string& path, int width, int height, const std::vector<std::uint8_t>& rgb) {
  const Location where{.file = path, .line = 0, .object = {}, .element = {}};
  if (width <= 0 || height <= 0 || rgb.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3)
    throw Error(where, "the pixels of a picture do not match its size");
  AtomicFile file(path);
  std::string bytes;  // the encoded picture; written afterwards, because exceptions must not pass through stb's C code
  const auto gather = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  if (stbi_write_png_to_func(gather, &bytes, width, height, 3, rgb.data(), width * 3) == 0)
    throw Error(where, "a picture cannot be encoded as PNG");
  file.write(bytes);
  file.commit();
}

}  // namespace pliant::render
