// Tests reading files as bytes: anything but a regular file is rejected at once and never waited for.
#include <sys/stat.h>

#include "io/file_bytes.h"
#include "mesh_support.h"
#include "write_support.h"

namespace pliant::test {
namespace {

std::string error_of_reading(const std::string& path, std::uint64_t most = largest_file) {
  try {
    read_file_bytes(path, most);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(FileBytes, ReadsWholeFiles) {
  const Folder folder;
  for (const std::size_t size : {0u, 1u, 4095u, 4096u, 4097u, 1000000u}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 7);
    put(folder / "file", bytes);
    EXPECT_EQ(read_file_bytes(folder / "file"), bytes);
  }
  EXPECT_FALSE(read_file_bytes("/proc/self/status").empty()) << "a file that says it has no length";
}

TEST(FileBytes, RefusesWhatIsNoFile) {
  const Folder folder;
  const std::string pipe = folder / "pipe.obj";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(contains(error_of_reading(pipe), pipe + ": is a pipe, socket or device"));
  EXPECT_TRUE(contains(error_of_reading("/dev/zero"), "/dev/zero: is a pipe, socket or device"));
  EXPECT_TRUE(contains(error_of_reading(folder.path()), folder.path() + ": is a folder"));
  EXPECT_TRUE(contains(error_of_reading(folder / "none.obj"), folder / "none.obj: cannot open: No such file"));
  EXPECT_TRUE(contains(error_of_reading(""), "path is empty"));
  EXPECT_TRUE(contains(error_of_reading(std::string("a\0b", 3)), "zero byte"));
}

TEST(FileBytes, RefusesWhatIsTooLarge) {
  const Folder folder;
  put(folder / "file", "12345");
  EXPECT_EQ(error_of_reading(folder / "file", 5), "");
  EXPECT_TRUE(contains(error_of_reading(folder / "file", 4), folder / "file: is larger than 4 bytes"));
  EXPECT_TRUE(contains(error_of_reading("/proc/self/status", 4), "is larger than 4 bytes"))
      << "found out while reading";
}

}  // namespace
}  // namespace pliant::test
