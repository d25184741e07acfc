#include "apps/command_line/usage.h"

#include <algorithm>

#include "scene_hints.h"

namespace pliant::command {

std::string did_you_mean(const std::string& wanted, const std::vector<std::string>& names) {
  const std::string near = wanted.empty() ? "" : scene_file::nearest_name(wanted, names);
  return near.empty() ? "" : "did you mean '" + near + "'? ";
}

std::string did_you_mean_option(const std::vector<std::string>& words, const std::vector<std::string>& options) {
  const auto is_option = [](const std::string& word) { return word.rfind("--", 0) == 0; };
  const auto first = std::find_if(words.begin(), words.end(), is_option);
  return first == words.end() ? "" : did_you_mean(*first, options);
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace pliant::command
