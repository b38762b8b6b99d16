// What every file of a method defines.
#pragma once

#include "exactff/methods.h"

namespace exactff::methods {

#define EXACTFF_METHOD(name) Method name##_method();
#include "methods/list.h"
#undef EXACTFF_METHOD

}  // namespace exactff::methods
