#pragma once
/// Defines VOXDAG_TSAN in builds with ThreadSanitizer.

#if defined(__SANITIZE_THREAD__)
#define VOXDAG_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define VOXDAG_TSAN 1
#endif
#endif
