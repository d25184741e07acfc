// Names the elements and attributes of a robot description that the reader ignores.
#pragma once

#include <string>
#include <vector>

namespace tinyxml2 {
class XMLElement;
}

namespace pliant::urdf {

/// Adds a warning for each kind of element or attribute that read() ignores, with the line of the first one, and a
/// similar name where the name is unknown.
void name_ignored(const tinyxml2::XMLElement& robot, const std::string& path, std::vector<std::string>& warnings);

}  // namespace pliant::urdf
