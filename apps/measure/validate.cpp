// pliant validate: compares with the known answers of apps/validate, as a table and as charts.
#include "apps/validate/validate.h"

#include <algorithm>
#include <memory>

#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "apps/command_line/simulate.h"
#include "apps/measure/measure.h"
#include "apps/plot/canvas.h"
#include "atomic_file.h"
#include "pliant/error.h"

namespace pliant::command {

namespace {

void refuse_bad_plot_name(const std::string& path) {
  if (path.empty() || has_suffix(path, ".png")) return;
  Location where;
  where.file = path;
  throw Error(where, "is not a .png", "give --plot a name that ends in .png");
}

void write_or_print(const std::string& text, AtomicFile* file) {
  if (file == nullptr) return print(text);
  file->write(text);
  file->commit();
}

}  // namespace

int validate(const ValidateOptions& options) {
  refuse_bad_plot_name(options.plot);
  const bool json_instead = options.json == "-";
  std::unique_ptr<AtomicFile> json_file;
  if (!options.json.empty() && !json_instead) json_file = std::make_unique<AtomicFile>(options.json);

  pliant::validate::Options wanted;
  if (!options.group.empty()) wanted.name = options.group;
  wanted.slow = options.slow;
  wanted.queries = options.queries;
  const pliant::validate::Result result = pliant::validate::run_validation(wanted);
  throw_if_interrupted();

  if (!json_instead) print(pliant::validate::to_table(result.rows));
  if (!options.json.empty()) write_or_print(pliant::validate::to_json(result.rows), json_file.get());
  if (!options.plot.empty()) pliant::plot::write_png(options.plot, pliant::plot::paint(result.charts));

  const auto failed = std::count_if(result.rows.begin(), result.rows.end(), [](const auto& row) { return !row.pass; });
  if (failed == 0) return 0;
  const auto first = std::find_if(result.rows.begin(), result.rows.end(), [](const auto& row) { return !row.pass; });
  throw Error({}, std::to_string(failed) + " of " + std::to_string(result.rows.size()) +
                      " rows fail, the first: " + first->name);
}

}  // namespace pliant::command
