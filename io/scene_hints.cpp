// Finds similar names: first in the record itself, then in records below it, then in those that a scene has once.
#include "scene_hints.h"

#include <algorithm>
#include <array>
#include <utility>

namespace pliant::scene_file {

namespace {

constexpr std::size_t longest_name = 64;  // longest name that is compared; all names of the format are shorter

std::string nearest_spelling(const std::string& wanted, const std::vector<std::string>& names) {
  std::string best;
  std::size_t least = std::max<std::size_t>(1, wanted.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(wanted, name);
    if (distance < least) best = name, least = distance;
  }
  return best;
}

std::vector<std::string> field_names_of(const Record& record) {
  std::vector<std::string> names;
  for (const Field& field : record.fields) names.push_back(field.name);
  return names;
}

/// A record and the path to it: "settings.sweep_options", "objects[].cloth"; empty for the first record.
struct Reached {
  const Record* record;
  std::string path;
};

/// Adds the records that a value of `type` can be.
void reach(const Type& type, const std::string& path, std::vector<Reached>& reached) {
  const auto is_it = [&](const Reached& one) { return one.record == type.record; };
  const bool is_new = type.record != nullptr && std::none_of(reached.begin(), reached.end(), is_it);
  if (is_new) reached.push_back({type.record, path});
  for (const Type& part : type.parts) reach(part, path + (type.kind == Type::Kind::list ? "[]" : ""), reached);
}

/// All records that can be reached from `first`, in breadth-first order, each once by its shortest path.
std::vector<Reached> reached_from(const Record& first) {
  std::vector<Reached> reached{{&first, {}}};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const Reached from = reached[i];
    const std::string before = from.path.empty() ? "" : from.path + ".";
    for (const Field& field : from.record->fields) reach(field.type, before + field.name, reached);
  }
  return reached;
}

/// The scene and its settings. Records in lists are left out: a name of one kind of object means nothing in another.
std::vector<Reached> reached_once() {
  std::vector<Reached> all = reached_from(scene_record());
  std::erase_if(all, [](const Reached& one) { return one.path.find("[]") != std::string::npos; });
  return all;
}

/// The first member of a record whose name means the same as `wanted`, as other programs say it; empty if there is
/// none.
std::string same_meaning(const std::string& wanted, const Record& record) {
  using Pair = std::array<const char*, 2>;
  static constexpr std::array<Pair, 8> pairs{Pair{"damping", "friction"},     Pair{"translate", "position"},
                                             Pair{"translation", "position"}, Pair{"location", "position"},
                                             Pair{"orientation", "rotation"}, Pair{"weight", "mass"},
                                             Pair{"extents", "half_extents"}, Pair{"bounce", "restitution"}};
  for (const auto& [other, name] : pairs)
    if (wanted == other && record.find(name) != nullptr) return name;
  return {};
}

/// The path of another record that has a member of this name; empty if there is none.
std::string home_of(const std::string& wanted, const std::vector<Reached>& reached) {
  for (const Reached& one : reached) {
    if (one.record->find(wanted) == nullptr) continue;
    return "it is a member of " + one.record->name + (one.path.empty() ? "" : ", as '" + one.path + "." + wanted + "'");
  }
  return {};
}

/// The most similar member name of all these records, with its path; empty if none is similar.
std::string nearest_elsewhere(const std::string& wanted, const std::vector<Reached>& reached) {
  std::vector<std::string> names;
  for (const Reached& one : reached)
    for (std::string& name : field_names_of(*one.record)) names.push_back(std::move(name));
  const std::string near =
      wanted.size() < 4 ? "" : nearest_spelling(wanted, names);  // short names are similar to too many
  for (const Reached& one : reached)
    if (!near.empty() && one.record->find(near) != nullptr)
      return "did you mean '" + (one.path.empty() ? "" : one.path + ".") + near + "'" +
             (one.path.empty() ? " of the scene?" : "?");
  return {};
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + ("'" + names[i] + "'");
  return text;
}

}  // namespace

std::string nearest_name(const std::string& wanted, const std::vector<std::string>& names) {
  if (wanted.size() > longest_name) return {};
  std::string best = nearest_spelling(wanted, names);
  if (!best.empty() || wanted.size() < 4) return best;
  for (const std::string& name : names)  // for 'friction' this finds 'static_friction'
    if (name.find(wanted) != std::string::npos) return name;
  return best;
}

std::string hint_for(const std::string& wanted, const Record& record) {
  const std::vector<std::string> names = field_names_of(record);
  if (wanted.size() <= longest_name) {
    if (const std::string near = nearest_name(wanted, names); !near.empty()) return "did you mean '" + near + "'?";
    if (const std::string same = same_meaning(wanted, record); !same.empty()) return "did you mean '" + same + "'?";
    const std::vector<Reached> below = reached_from(record), once = reached_once();
    for (const auto& look : {home_of, nearest_elsewhere})
      for (const auto* reached : {&below, &once})
        if (std::string hint = look(wanted, *reached); !hint.empty()) return hint;
  }
  return names.empty() ? "this record has no members" : "known are " + joined(names);
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1),
      row(b.size() + 1);  // rows i - 2, i - 1 and i of the edit distance table
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last), last.swap(row);
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const std::size_t changed = last[k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1);
      row[k] = std::min({last[k] + 1, row[k - 1] + 1, changed});
      const bool swapped = i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1];
      if (swapped) row[k] = std::min(row[k], before[k - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace pliant::scene_file
