// Tests damaged files: every prefix of small files, and thousands of random changes to them. Each must give a valid
// mesh or an Error. Under the sanitizers this is a small fuzzer; tests/fuzz has the large ones.
#include <algorithm>
#include <random>

#include "mesh_support.h"

namespace pliant::test {
namespace {

struct Sample {
  std::string name, bytes;
};

std::vector<Sample> samples() {
  std::vector<Sample> all;
  all.push_back(
      {"a.obj",
       "# a comment\nmtllib x.mtl\nv 0 0 0 1 0 0\nv 1.5 -2e-1 .25\nv +1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nl 1 2\n"
       "f 1 2 3 4\nf -1/1/1 -2//1 \\\n -3/1\ng a\nf 1/1 2/1 3/1\n"});
  const std::string body =
      "element vertex 4\nproperty float x\nproperty double y\nproperty short z\nelement face 2\nproperty uchar flag\n"
      "property list uchar int vertex_indices\nproperty list int float more\nend_header\n";
  all.push_back({"a.ply", "ply\nformat ascii 1.0\ncomment c\n" + body +
                              "0 0 0\n1 0 0\n1 1 0\n0 1 0\n7 4 0 1 2 3 0\n7 3 0 1 2 2 .5 .5\n"});
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + body;
    for (const int corner : {0, 1, 3, 2})
      bytes += bytes_of(static_cast<float>(corner & 1), big) + bytes_of(static_cast<double>(corner >> 1), big) +
               bytes_of(std::int16_t{0}, big);
    for (const int count : {4, 3}) {
      bytes += std::string(1, 'x') + bytes_of(static_cast<std::uint8_t>(count));
      for (int i = 0; i < count; ++i) bytes += bytes_of(i, big);
      bytes += bytes_of(1, big) + bytes_of(0.5f, big);
    }
    all.push_back({"b.ply", bytes});
  }
  all.push_back({"a.stl",
                 "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                 "0\nendloop\nendfacet\nendsolid a\n"});
  std::string binary(80, 'h');
  binary += bytes_of(std::uint32_t{2});
  for (int i = 0; i < 2; ++i) {
    for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, static_cast<float>(i), 0.f, 1.f, 0.f})
      binary += bytes_of(value);
    binary += "at";
  }
  all.push_back({"b.stl", binary});
  return all;
}

/// Reads the bytes with every combination of options. True if they could be read.
bool is_read(const std::string& bytes, const std::string& name) {
  bool read = false;
  for (const MeshReadOptions options : {MeshReadOptions{}, as_it_is}) try {
      const MeshFile file = parse_mesh(bytes, name, options);
      expect_sound(file.mesh);
      inspect(file.mesh);
      read = true;
    } catch (const Error& error) {
      EXPECT_TRUE(contains(error.what(), name));
      EXPECT_FALSE(error.problem().empty());
    }
  return read;
}

TEST(MeshFuzz, SamplesAreSound) {
  for (const Sample& sample : samples()) EXPECT_TRUE(is_read(sample.bytes, sample.name)) << sample.name;
}

TEST(MeshFuzz, EveryPrefix) {
  for (const Sample& sample : samples())
    for (std::size_t size = 0; size < sample.bytes.size(); ++size) is_read(sample.bytes.substr(0, size), sample.name);
}

TEST(MeshFuzz, NoBinaryPrefixIsTakenForTheWhole) {
  for (const Sample& sample : samples()) {
    if (sample.name[0] != 'b') continue;
    for (std::size_t size = 0; size < sample.bytes.size(); ++size)
      EXPECT_FALSE(is_read(sample.bytes.substr(0, size), sample.name)) << sample.name << " cut to " << size;
  }
}

TEST(MeshFuzz, SeededDamage) {
  std::mt19937 random(2026);
  const std::string pieces[] = {
      "nan", "inf", "-1",    "0",    "99999999999",       "1e999", "\n", "\r", " ", "\\\n", "/", "f",
      "v",   "-",   "solid", "list", std::string(1, '\0')};
  int read = 0, refused = 0;
  for (const Sample& sample : samples())
    for (int round = 0; round < 1500; ++round) {
      std::string bytes = sample.bytes;
      const int changes = 1 + static_cast<int>(random() % 3);
      for (int i = 0; i < changes && !bytes.empty(); ++i) {
        const std::size_t at = random() % bytes.size();
        const std::string& piece = pieces[random() % std::size(pieces)];
        switch (random() % 5) {
          case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1u << random() % 8));
            break;
          case 1:
            bytes[at] = static_cast<char>(random());
            break;
          case 2:
            bytes.erase(at, 1 + random() % 8);
            break;
          case 3:
            bytes.insert(at, piece);
            break;
          default:
            bytes.replace(at, std::min(piece.size(), bytes.size() - at), piece);
            break;
        }
      }
      ++(is_read(bytes, sample.name) ? read : refused);
    }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace pliant::test
