// The messages that bad input causes.
#pragma once

#include <string>

#include "exactff/error.h"

namespace exactff::validation {

// The messages of the InputError that `act` throws; empty if it throws none.
template <class Act>
std::string complaint(const Act& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace exactff::validation
