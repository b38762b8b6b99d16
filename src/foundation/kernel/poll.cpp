#include "kernel/poll.h"

#include <utility>

#include "kernel/expect.h"

namespace exactff {

HooksOfThread::HooksOfThread(const Hooks& hooks) : before_(std::exchange(kernel::hooks_of_thread, &hooks)) {}
HooksOfThread::~HooksOfThread() { kernel::hooks_of_thread = before_; }

void kernel::ask_hooks() {
  EXACTFF_EXPECT(hooks_of_thread != nullptr);
  if (hooks_of_thread->cancelled && hooks_of_thread->cancelled()) throw Cancelled();
}

void kernel::Steps::tell() const {
  ask_hooks();
  if (hooks_of_thread->progress) hooks_of_thread->progress({stage_, taken_, total_});
}

}  // namespace exactff
