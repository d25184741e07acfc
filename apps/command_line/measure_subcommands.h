// The subcommands of `pliant` that the program pliant-measure holds. `pliant --help` lists them too.
#pragma once

namespace pliant::command {

struct MeasureSubcommand {
  const char* name;
  const char* description;  ///< in the help
};

inline constexpr MeasureSubcommand validate_subcommand{"validate",
                                                       "Compare the engine with known answers of mechanics"};
inline constexpr MeasureSubcommand bench_subcommand{
    "bench", "Measure the time of frames, compared with a plain loop and another engine"};
inline constexpr MeasureSubcommand compare_subcommand{"compare", "Compare how fast sweeps solve a scene"};
inline constexpr MeasureSubcommand measure_subcommands[] = {validate_subcommand, bench_subcommand, compare_subcommand};

}  // namespace pliant::command
