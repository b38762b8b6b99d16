#include "kernel/tangent.h"

namespace exactff::kernel {

Ball tan(const Ball& a) { return ball_of<arb_tan>(a); }

}  // namespace exactff::kernel
