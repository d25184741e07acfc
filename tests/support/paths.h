// Where the tests find files. The paths themselves are in one source alone (paths.cpp.in), so that all other sources
// compile to the same objects wherever the tree lies, and compilers' caches find them.
#pragma once

#include <string>

namespace pliant::test {

/// The absolute path of a file or folder, given from the root of the source tree: in_tree("scenes/drape.json").
std::string in_tree(const std::string& path);

/// The absolute path of a file or folder of the data that not every tree has: in_shared_data("ccd").
std::string in_shared_data(const std::string& path);

}  // namespace pliant::test
