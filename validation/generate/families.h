// The library's own, under the name by which tests know it.
#pragma once

#include "models/families.h"

namespace exactff {
namespace generate = models;
}
