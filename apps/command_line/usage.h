// Advice for a wrong command line.
#pragma once

#include <string>
#include <vector>

namespace pliant::command {

/// "did you mean 'NAME'? " with the most similar name; empty if none is similar.
std::string did_you_mean(const std::string& wanted, const std::vector<std::string>& names);

/// The same with the first of `words` that is an option ("--frame"). `options` are names such as "--frames".
std::string did_you_mean_option(const std::vector<std::string>& words, const std::vector<std::string>& options);

/// The names, separated by commas.
std::string joined(const std::vector<std::string>& names);

}  // namespace pliant::command
