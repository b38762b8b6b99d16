// Whether address sanitizing is on: it needs terabytes of addresses, a large stack and several times the time.
#pragma once

namespace exactff {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
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
