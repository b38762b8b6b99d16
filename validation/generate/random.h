// The library's own, under the name by which tests know it.
#pragma once

#include "models/random.h"

namespace exactff {
namespace generate = models;
}
