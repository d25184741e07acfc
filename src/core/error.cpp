// Makes the text of an Error.
#include "pliant/error.h"

#include <utility>

namespace pliant {

namespace {

std::string place(const Location& where) {
  std::string text = where.file;
  if (where.line > 0) text += ":" + std::to_string(where.line);
  if (where.line > 0 && where.column > 0) text += ":" + std::to_string(where.column);
  std::string part = where.object.empty() ? std::string() : "object '" + where.object + "'";
  if (!where.element.empty()) part += (part.empty() ? "" : ", ") + where.element;
  if (!text.empty() && !part.empty()) text += ": ";
  return text + part;
}

std::string sentence(const Location& where, const std::string& problem, const std::string& advice) {
  std::string text = place(where);
  if (!text.empty()) text += ": ";
  text += problem;
  if (!advice.empty()) text += "; " + advice;
  return text;
}

}  // namespace

Error::Error(Location where, std::string problem, std::string advice)
    : std::runtime_error(sentence(where, problem, advice)),
      where_(std::move(where)),
      problem_(std::move(problem)),
      advice_(std::move(advice)) {}

}  // namespace pliant
