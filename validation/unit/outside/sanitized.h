// Whether addresses or threads are sanitized, which needs terabytes of addresses, a large stack and several times the
// time.
#pragma once

namespace exactff {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

#ifdef NDEBUG
inline constexpr bool kAtFullSpeed = !kSanitized;
#else
inline constexpr bool kAtFullSpeed = false;
#endif

}  // namespace exactff
