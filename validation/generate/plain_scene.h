// The library's own, under the name by which tests know it.
#pragma once

#include "models/plain_scene.h"

namespace exactff {
namespace generate = models;
}
