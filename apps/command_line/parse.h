// How pliant and pliant-measure read their command lines. CLI11 takes seconds to compile, so only their main.cpp
// include this.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "apps/command_line/guard.h"
#include "apps/command_line/usage.h"
#include "pliant/version.h"

namespace pliant::command {

/// The function that main will call; each subcommand stores its own.
using Chosen = std::function<int()>;

constexpr int most = std::numeric_limits<int>::max();
constexpr int most_threads = 1024;  // limit of threads, as in scene files

/// Checks a range, with a message; unlike CLI11's check it adds nothing to the help.
template <class Number>
CLI::Validator range(Number least, Number largest) {
  return CLI::Validator(CLI::Range(least, largest)).description("");
}

/// Sets what both programs have in common: to users they are one command.
inline void set_up(CLI::App& app) {
  app.name("pliant");
  app.description(
      "A position based dynamics engine: cloth, ropes, rods, soft and rigid bodies, joints, liquids, gases, grains");
  app.set_version_flag("--version", "pliant " PLIANT_VERSION);
  app.require_subcommand(0, 1);  // so that an unknown subcommand is named instead of reported missing
}

inline std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* subcommand : app.get_subcommands(nullptr)) names.push_back(subcommand->get_name());
  return names;
}

inline std::vector<std::string> long_options(const CLI::App& subcommand) {
  std::vector<std::string> names;
  for (const CLI::Option* option : subcommand.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// Advice for a wrong command line: the list of subcommands if one is unknown, otherwise how to get help.
inline std::string usage_advice(const CLI::App& app, const std::string& unknown_subcommand) {
  if (const auto given = app.get_subcommands(); !given.empty()) {
    const CLI::App& first = *given.front();
    return did_you_mean_option(first.remaining(), long_options(first)) + "see pliant " + first.get_name() + " --help";
  }
  const std::vector<std::string> names = subcommand_names(app);
  return did_you_mean(unknown_subcommand, names) + "the subcommands are " + joined(names) + "; see pliant --help";
}

/// Prints the help or the version, or what is wrong with the command line. Returns the exit status.
inline int answer(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
  const bool unknown = app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-';
  const std::string problem = unknown ? "there is no subcommand '" + std::string(argv[1]) + "'" : error.what();
  complain(problem + "; " + usage_advice(app, unknown ? argv[1] : ""));
  return 2;
}

/// Reads the command line, calls the subcommand that it chooses and returns the exit status.
inline int parse_and_run(CLI::App& app, const Chosen& chosen, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return answer(app, error, argc, argv);
  }
  if (chosen) return run_guarded(chosen);
  complain("no subcommand is given; " + usage_advice(app, ""));
  return 2;
}

}  // namespace pliant::command
