// Reports read studies, and use their names without the namespace.
#pragma once

#include "exactff/study.h"

namespace exactff::report {

using namespace study;

}  // namespace exactff::report
