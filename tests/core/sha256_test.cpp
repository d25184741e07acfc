// Compares SHA-256 with the examples in FIPS 180-4, and hashes of pieces with hashes of the whole.
#include "core/sha256.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace pliant {
namespace {

std::string sha256(const std::string& text) {
  Sha256 sha;
  sha.add(text.data(), text.size());
  return sha.finish();
}

TEST(Sha256, OfThePublishedExamples) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, TakesPiecesOfAnySize) {
  std::string text;
  for (int i = 0; i < 300; ++i) text.push_back(static_cast<char>(i * 7));
  for (std::size_t length = 0; length <= text.size(); ++length) {
    const std::string part = text.substr(0, length);
    Sha256 sha;
    for (std::size_t at = 0, piece = 1; at < length; at += piece, piece = piece % 71 + 1)
      sha.add(part.data() + at, std::min(piece, length - at));
    EXPECT_EQ(sha.finish(), sha256(part)) << length << " bytes";
  }
}

TEST(Sha256, IsTheSameByAnyCode) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text.push_back(static_cast<char>(i * i + 3 * i));
  for (std::size_t length = 0; length <= text.size(); length += 13) {
    Sha256 portable(Sha256Code::portable);
    portable.add(text.data(), length);
    EXPECT_EQ(portable.finish(), sha256(text.substr(0, length))) << length << " bytes";
  }
}

TEST(Sha256, OfThePublishedExamplesInPortableCode) {
  Sha256 portable(Sha256Code::portable);
  portable.add("abc", 3);
  EXPECT_EQ(portable.finish(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace pliant
