// What tests of messages share.
#pragma once

#include <string>

#include "pliant/error.h"

namespace pliant::testing_support {

/// The message of the Error that a call throws; "nothing was refused" if it throws none.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was refused";
}

}  // namespace pliant::testing_support
